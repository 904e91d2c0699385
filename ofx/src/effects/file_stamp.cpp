// SPDX-License-Identifier: Apache-2.0
#include "effects/file_stamp.h"

#include <algorithm>
#include <system_error>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"

namespace metamer::ofx {

void FileStamps::add(const std::filesystem::path& file) {
  m_stamps.push_back(stampOf(file));
}

bool FileStamps::areCurrent() const {
  return std::all_of(m_stamps.begin(), m_stamps.end(), [](const Stamp& stamp) { return stamp == stampOf(stamp.file); });
}

FileStamps::Stamp FileStamps::stampOf(const std::filesystem::path& file) {
  std::error_code missing;
  Stamp stamp{file, std::filesystem::file_size(file, missing), {}};
  if (missing) {
    stamp.size = static_cast<std::uintmax_t>(-1);
    return stamp;
  }
  stamp.time = std::filesystem::last_write_time(file, missing);
  return stamp;
}

void requireFile(const std::filesystem::path& file, const std::string& parameter, const std::string& remedy) {
  std::error_code missing;
  if (!std::filesystem::is_regular_file(file, missing)) {
    throw spectral::InputError(spectral::utf8(file), parameter, "", "no such file; " + remedy);
  }
}

}  // namespace metamer::ofx
