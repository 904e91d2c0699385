// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/pixel_set.h"

#include <cmath>
#include <sstream>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/text.h"

namespace metamer::spectral {
namespace {

constexpr const char* kHeader = "kind,red,green,blue";

}  // namespace

std::vector<SetPixel> readPixelSet(const std::filesystem::path& file) {
  const std::string where = utf8(file);
  std::istringstream text(readTextFile(file));
  std::string line;
  if (!std::getline(text, line) || trimmed(line) != kHeader) {
    throw InputError(where, "header", line, std::string("must be ") + kHeader);
  }
  std::vector<SetPixel> pixels;
  while (std::getline(text, line)) {
    SetPixel pixel;
    std::istringstream cells(line);
    std::getline(cells, pixel.kind, ',');
    for (double& channel : pixel.rgb) {
      std::string cell;
      std::getline(cells, cell, ',');
      const auto number = parseNumber(trimmed(cell));
      if (!number || !std::isfinite(*number)) {
        throw InputError(where, "row", line, "must be a kind and three finite numbers");
      }
      channel = *number;
    }
    pixels.push_back(std::move(pixel));
  }
  return pixels;
}

}  // namespace metamer::spectral
