// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/picture_file.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <vector>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"

namespace metamer::spectral {
namespace {

constexpr std::string_view kEnd = "IEND";

/// CRC-32 of ISO 3309, a byte at a time.
std::array<std::uint32_t, 256> crcTable() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t n = 0; n < table.size(); ++n) {
    std::uint32_t c = n;
    for (int bit = 0; bit < 8; ++bit) {
      c = (c & 1U) != 0 ? 0xedb88320U ^ (c >> 1U) : c >> 1U;
    }
    table[n] = c;
  }
  return table;
}

std::uint32_t crcOf(std::uint32_t crc, const char* bytes, std::size_t count) {
  static const std::array<std::uint32_t, 256> table = crcTable();
  for (std::size_t k = 0; k < count; ++k) {
    crc = table[(crc ^ static_cast<unsigned char>(bytes[k])) & 0xffU] ^ (crc >> 8U);
  }
  return crc;
}

}  // namespace

std::uint32_t bigEndian(const char* bytes) {
  std::uint32_t value = 0;
  for (int k = 0; k < 4; ++k) {
    value = (value << 8U) | static_cast<unsigned char>(bytes[k]);
  }
  return value;
}

void requirePictureFile(const std::string& file) {
  std::error_code none;
  const std::filesystem::file_status status = std::filesystem::status(pathOf(file), none);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw InputError(file, "", "", "is a folder, pipe or device; name a picture file");
  }
  std::ifstream stream(file, std::ios::binary);
  std::array<char, 8> head{};
  if (!stream.read(head.data(), head.size()) || std::string_view(head.data(), head.size()) != kPngSignature) {
    return;
  }
  std::vector<char> block(std::size_t{1} << 16U);
  std::uint64_t at = head.size();
  const auto refuse = [&](const char* what) {
    throw InputError(file, "byte", std::to_string(at), std::string(what) + "; write the picture again");
  };
  // A chunk: length, name, content, CRC of name and content.
  for (bool isEnd = false; !isEnd;) {
    if (!stream.read(head.data(), head.size())) {
      refuse("the PNG is cut short there");
    }
    std::uint64_t left = bigEndian(head.data());
    isEnd = std::string_view(head.data() + 4, 4) == kEnd;
    std::uint32_t crc = crcOf(0xffffffffU, head.data() + 4, 4);
    while (left > 0) {
      const std::size_t count = std::min<std::uint64_t>(left, block.size());
      if (!stream.read(block.data(), static_cast<std::streamsize>(count))) {
        refuse("the PNG is cut short behind it");
      }
      crc = crcOf(crc, block.data(), count);
      left -= count;
    }
    if (!stream.read(head.data(), 4)) {
      refuse("the PNG is cut short behind it");
    }
    if ((crc ^ 0xffffffffU) != bigEndian(head.data())) {
      refuse("the PNG is damaged behind it");
    }
    at = static_cast<std::uint64_t>(stream.tellg());
  }
}

}  // namespace metamer::spectral
