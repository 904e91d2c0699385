// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral_ref/checkpoint.h"

#include <cstring>
#include <fstream>
#include <string_view>
#include <system_error>

#include "fingerprint.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/pending_file.h"

namespace metamer::spectral_ref {
namespace {

std::uint64_t checkSum(const std::vector<unsigned char>& bytes, std::size_t size) {
  // Word by word: a checkpoint may be a gigabyte.
  Fingerprint sum;
  std::uint64_t mixed = 0;
  std::size_t i = 0;
  for (; i + sizeof(std::uint64_t) <= size; i += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, sizeof word);
    mixed = (mixed ^ word) * 0x9e3779b97f4a7c15U;
    mixed ^= mixed >> 32U;
  }
  sum.add(&mixed, sizeof mixed);
  sum.add(bytes.data() + i, size - i);
  return sum.value();
}

}  // namespace

void writeCheckpoint(const std::vector<unsigned char>& state, const std::filesystem::path& file) {
  std::vector<unsigned char> bytes = state;
  const std::uint64_t sum = checkSum(bytes, bytes.size());
  const auto* sumBytes = reinterpret_cast<const unsigned char*>(&sum);
  bytes.insert(bytes.end(), sumBytes, sumBytes + sizeof sum);
  spectral::writeWholeFile(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::vector<unsigned char> readCheckpoint(const std::filesystem::path& file) {
  std::error_code none;
  const std::uintmax_t size = std::filesystem::file_size(file, none);
  std::ifstream stream(file, std::ios::binary);
  std::vector<unsigned char> bytes(none || !stream ? 0 : static_cast<std::size_t>(size));
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (none || !stream) {
    throw spectral::InputError(file.string(), "checkpoint", "", "cannot be read; check its permissions");
  }
  std::uint64_t stored = 0;
  if (bytes.size() >= sizeof stored) {
    std::memcpy(&stored, bytes.data() + bytes.size() - sizeof stored, sizeof stored);
    bytes.resize(bytes.size() - sizeof stored);
    if (checkSum(bytes, bytes.size()) == stored) {
      return bytes;
    }
  }
  throw spectral::InputError(file.string(), "checkpoint", "",
                             "is damaged or of another release; delete it and start again");
}

}  // namespace metamer::spectral_ref
