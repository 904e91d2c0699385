// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral_ref/checkpoint.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

#include "film/check_sum.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"

namespace metamer::spectral_ref {
namespace {

/// Bytes that are written, read and summed at a time.
constexpr std::size_t kPiece = std::size_t{1} << 20U;
static_assert(kPiece % CheckSum::kWord == 0);

/// Gathers small pieces, and writes and sums large ones.
class CheckpointFile {
 public:
  explicit CheckpointFile(const std::filesystem::path& file)
      : m_pending(file), m_stream(m_pending.path(), std::ios::binary) {
    m_buffer.reserve(kPiece);
  }

  void add(const void* bytes, std::size_t size) {
    const auto* from = static_cast<const unsigned char*>(bytes);
    while (size > 0) {
      const std::size_t count = std::min(size, kPiece - m_buffer.size());
      m_buffer.insert(m_buffer.end(), from, from + count);
      from += count;
      size -= count;
      if (m_buffer.size() == kPiece) {
        flush();
      }
    }
  }
  void finish() {
    flush();
    const std::uint64_t sum = m_sum.value();
    m_stream.write(reinterpret_cast<const char*>(&sum), sizeof sum);
    m_stream.close();
    check();
    m_pending.commit();
  }

 private:
  void flush() {
    m_sum.add(m_buffer.data(), m_buffer.size());
    m_stream.write(reinterpret_cast<const char*>(m_buffer.data()), static_cast<std::streamsize>(m_buffer.size()));
    check();
    m_buffer.clear();
  }
  void check() const {
    if (!m_stream) {
      throw spectral::InputError(
          spectral::utf8(m_pending.target()), "checkpoint", "",
          "cannot be written: " + std::string(std::strerror(errno)) + "; an older one stays as it was, make room");
    }
  }

  spectral::PendingFile m_pending;
  std::ofstream m_stream;
  std::vector<unsigned char> m_buffer;
  CheckSum m_sum;
};

}  // namespace

void writeCheckpoint(const std::function<void(const ByteSink&)>& state, const std::filesystem::path& file) {
  CheckpointFile checkpoint(file);
  state([&](const void* bytes, std::size_t size) { checkpoint.add(bytes, size); });
  checkpoint.finish();
}

void readCheckpoint(const std::filesystem::path& file, const std::function<void(const ByteSource&)>& state) {
  const auto error = [&file](const char* remedy) {
    return spectral::InputError(spectral::utf8(file), "checkpoint", "", remedy);
  };
  constexpr const char* kUnreadable = "cannot be read; check its permissions";
  constexpr const char* kDamaged = "is damaged or of another release; delete it and start again";
  std::error_code none;
  const std::uintmax_t whole = std::filesystem::file_size(file, none);
  if (none) {
    throw error(kUnreadable);  // a pipe too: it might never open
  }
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    throw error(kUnreadable);
  }
  const auto read = [&](void* bytes, std::size_t size) {
    stream.read(static_cast<char*>(bytes), static_cast<std::streamsize>(size));
    if (!stream) {
      throw error(kUnreadable);
    }
  };
  std::uint64_t stored = 0;
  if (whole < sizeof stored) {
    throw error(kDamaged);
  }
  const std::uint64_t size = whole - sizeof stored;
  // Twice through the file instead of once into memory: what is damaged must be seen before any of it is taken over.
  CheckSum sum;
  std::vector<unsigned char> piece(static_cast<std::size_t>(std::min<std::uint64_t>(size, kPiece)));
  for (std::uint64_t left = size; left > 0;) {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(left, kPiece));
    read(piece.data(), count);
    sum.add(piece.data(), count);
    left -= count;
  }
  read(&stored, sizeof stored);
  if (sum.value() != stored) {
    throw error(kDamaged);
  }
  stream.seekg(0);
  state({read, size});
}

}  // namespace metamer::spectral_ref
