// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/pending_folder.h"

#include <system_error>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"

namespace metamer::spectral {
namespace fs = std::filesystem;

PendingFolder::PendingFolder(const fs::path& path) {
  fs::path folder;
  for (const fs::path& part : fs::absolute(path)) {
    folder /= part;
    std::error_code failure;
    if (part.empty() || fs::is_directory(folder, failure)) {
      continue;
    }
    m_made.emplace_back(folder);
    // Where another program has made it meanwhile, it is not this one's to remove.
    if (!fs::create_directory(folder, failure)) {
      m_made.pop_back();
    }
    if (failure) {
      throw InputError(utf8(path), "folder", "",
                       "cannot be made: " + failure.message() + "; choose a place that is there and writable");
    }
  }
}

PendingFolder::~PendingFolder() {
  for (auto made = m_made.rbegin(); made != m_made.rend(); ++made) {
    std::error_code none;
    fs::remove(made->path, none);  // only where it is empty
  }
}

}  // namespace metamer::spectral
