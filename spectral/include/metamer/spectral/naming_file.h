// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/missing_file_error.h"

namespace metamer::spectral {

/// Does work whose errors know a field and no file: they get the file's name before them, unless they have it, or name
/// one that is missing. An empty name adds nothing.
template <typename Work>
auto namingFile(const std::string& file, const Work& work) -> decltype(work()) {
  try {
    return work();
  } catch (const MissingFileError&) {
    throw;
  } catch (const InputError& error) {
    if (file.empty() || std::string(error.what()).find(file) != std::string::npos) {
      throw;
    }
    throw InputError(file, error.what(), "", "");
  }
}

}  // namespace metamer::spectral
