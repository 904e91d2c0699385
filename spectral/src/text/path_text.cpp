// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/path_text.h"

namespace metamer::spectral {

std::string utf8(const std::filesystem::path& path) {
  const std::u8string text = path.u8string();
  return {text.begin(), text.end()};
}

std::filesystem::path pathOf(std::string_view text) {
  return std::u8string(text.begin(), text.end());
}

}  // namespace metamer::spectral
