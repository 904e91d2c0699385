// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/patch_names.h"

#include "metamer/spectral/text.h"

namespace metamer::stage {

std::vector<int> patchesWith(const std::vector<std::string>& names, const std::string& word, bool atStart) {
  std::vector<int> found;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::size_t at = spectral::lowerCase(names[i]).find(spectral::lowerCase(word));
    if (at != std::string::npos && (!atStart || at == 0)) {
      found.push_back(static_cast<int>(i));
    }
  }
  return found;
}

int patchNamed(const std::vector<std::string>& names, const std::string& name) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (spectral::lowerCase(names[i]) == spectral::lowerCase(name)) {
      return static_cast<int>(i);
    }
  }
  const std::vector<int> starting = patchesWith(names, name, true);
  return starting.size() == 1 ? starting.front() : -1;
}

}  // namespace metamer::stage
