// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/pending_file.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <random>
#include <string>
#include <system_error>

#include "files/output_place.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/platform.h"

namespace metamer::spectral {
namespace {

namespace fs = std::filesystem;

/// Of most file systems, in bytes.
constexpr std::size_t kLongestName = 255;
constexpr const char* kMakeRoom = "; nothing is left behind, make room and try again";

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

std::string reason() {
  return "cannot be written: " + std::string(std::strerror(errno));
}

/// Beside a file, under another name with its extension.
fs::path partialName(const fs::path& place, unsigned number) {
  const std::string end = ".partial-" + std::to_string(number) + utf8(place.extension());
  std::string stem = utf8(place.stem());
  if (stem.size() + end.size() > kLongestName && end.size() < kLongestName) {
    stem.resize(kLongestName - end.size());
  }
  return place.parent_path() / pathOf(stem + end);
}

}  // namespace

PendingFile::PendingFile(fs::path target) : m_target(std::move(target)) {
  const OutputPlace found = outputPlace(m_target);
  m_place = found.path;
  m_isStream = found.isStream;
  const fs::path beside = m_isStream ? fs::temp_directory_path() / m_target.filename() : m_place;
  // Exclusive creation: never another program's file. Only the name is random, not the contents.
  std::random_device random;
  for (int attempt = 0; attempt < 16; ++attempt) {
    m_path = partialName(beside, random());
    const SignalsWait untilItIsThere;  // none that is made after a signal has removed what is unfinished
    m_unfinished.emplace(m_path);
    const std::unique_ptr<std::FILE, Close> file(openFile(m_path, "wbx"));
    if (file) {
      return;
    }
    m_unfinished.reset();
    if (errno != EEXIST) {
      break;
    }
  }
  throw InputError(utf8(m_target), "output", "", reason() + "; choose a folder that is there and writable");
}

PendingFile::~PendingFile() {
  if (!m_committed) {
    std::error_code none;
    fs::remove(m_path, none);
  }
}

void PendingFile::write(std::string_view contents) {
  std::unique_ptr<std::FILE, Close> file;
  {
    const SignalsWait untilItIsOpen;
    file.reset(openFile(m_path, "wb"));
  }
  const bool written = file && std::fwrite(contents.data(), 1, contents.size(), file.get()) == contents.size() &&
                       std::fflush(file.get()) == 0;
  const int failure = errno;
  if (!written || std::fclose(file.release()) != 0) {
    errno = written ? errno : failure;
    throw InputError(utf8(m_target), "output", "", reason() + kMakeRoom);
  }
}

void PendingFile::copyIntoStream() const {
  constexpr std::size_t kPiece = 1U << 16U;
  std::ifstream from(m_path, std::ios::binary);
  const std::unique_ptr<std::FILE, Close> into(openStream(m_place));
  std::string piece(kPiece, '\0');
  bool isWritten = into != nullptr;
  while (isWritten && from) {
    from.read(piece.data(), kPiece);
    const auto count = static_cast<std::size_t>(from.gcount());
    isWritten = std::fwrite(piece.data(), 1, count, into.get()) == count;
  }
  if (!isWritten || std::fflush(into.get()) != 0) {
    throw InputError(utf8(m_target), "output", "", reason() + "; name a file, or what takes it all");
  }
}

void PendingFile::commit() {
  if (m_isStream) {
    // Who reads may never come: signals do not wait.
    copyIntoStream();
    std::error_code none;
    fs::remove(m_path, none);
    finish();
    return;
  }
  const SignalsWait untilItIsThere;
  keepOwnerAndMode(m_place, m_path);
  std::error_code failure;
  fs::rename(m_path, m_place, failure);
  if (failure) {
    throw InputError(utf8(m_target), "output", "", "cannot be replaced: " + failure.message() + "; name another file");
  }
  finish();
}

void PendingFile::finish() {
  m_committed = true;
  m_unfinished.reset();
  countFinishedFile();
}

void commitAll(const std::vector<PendingFile*>& files) {
  for (PendingFile* file : files) {
    if (file->isStream()) {
      file->commit();
    }
  }
  const SignalsWait untilAllAreThere;
  for (PendingFile* file : files) {
    if (!file->isStream()) {
      file->commit();
    }
  }
}

void writeWholeFile(const fs::path& target, std::string_view contents) {
  PendingFile file(target);
  file.write(contents);
  file.commit();
}

bool isStream(const fs::path& target) {
  return outputPlace(target).isStream;
}

void requireWritable(const fs::path& target) {
  if (!target.empty()) {
    const PendingFile proof(target);
  }
}

}  // namespace metamer::spectral
