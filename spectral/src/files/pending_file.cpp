// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/pending_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <random>
#include <string>
#include <system_error>

#include "metamer/spectral/input_error.h"

namespace metamer::spectral {
namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

std::string reason() {
  return "cannot be written: " + std::string(std::strerror(errno));
}

}  // namespace

PendingFile::PendingFile(std::filesystem::path target) : m_target(std::move(target)) {
  std::error_code none;
  if (m_target.filename().empty() || std::filesystem::is_directory(m_target, none)) {
    throw InputError(m_target.string(), "output", "", "is a folder; name a file");
  }
  // Exclusive creation: never another program's file. Only the name is random, not the contents.
  std::random_device random;
  for (int attempt = 0; attempt < 16; ++attempt) {
    m_path = m_target;
    m_path.replace_filename(m_target.stem().string() + ".partial-" + std::to_string(random()) +
                            m_target.extension().string());
    const std::unique_ptr<std::FILE, Close> file(std::fopen(m_path.c_str(), "wbx"));
    if (file) {
      return;
    }
    if (errno != EEXIST) {
      break;
    }
  }
  throw InputError(m_target.string(), "output", "", reason() + "; choose a folder that is there and writable");
}

PendingFile::~PendingFile() {
  if (!m_committed) {
    std::error_code none;
    std::filesystem::remove(m_path, none);
  }
}

void PendingFile::write(std::string_view contents) {
  std::unique_ptr<std::FILE, Close> file(std::fopen(m_path.c_str(), "wb"));
  const bool written = file && std::fwrite(contents.data(), 1, contents.size(), file.get()) == contents.size() &&
                       std::fflush(file.get()) == 0;
  const int failure = errno;
  if (!written || std::fclose(file.release()) != 0) {
    errno = written ? errno : failure;
    throw InputError(m_target.string(), "output", "", reason() + "; nothing is left behind, make room and try again");
  }
}

void PendingFile::commit() {
  std::error_code failure;
  std::filesystem::rename(m_path, m_target, failure);
  if (failure) {
    throw InputError(m_target.string(), "output", "", "cannot be replaced: " + failure.message());
  }
  m_committed = true;
}

void writeWholeFile(const std::filesystem::path& target, std::string_view contents) {
  PendingFile file(target);
  file.write(contents);
  file.commit();
}

}  // namespace metamer::spectral
