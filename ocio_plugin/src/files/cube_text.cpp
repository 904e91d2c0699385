// SPDX-License-Identifier: Apache-2.0
#include "files/cube_text.h"

#include <charconv>
#include <cmath>

namespace metamer::ocio {
namespace {

/// Digits after the point: a tenth of the step of a 16-bit signal and more.
constexpr int kDigits = 7;

void appendComments(std::string& text, const LutDescription& description) {
  for (const auto& line : description.lines) {
    text += "# " + line + "\n";
  }
}

/// Plain decimal notation: some readers know no exponents.
void appendNumber(std::string& text, float value) {
  char digits[64];
  const double plain = std::abs(value) < 0.5e-7F ? 0.0 : static_cast<double>(value);
  const auto end = std::to_chars(digits, digits + sizeof digits, plain, std::chars_format::fixed, kDigits);
  text.append(digits, end.ptr);
}

void appendNode(std::string& text, const float* rgb) {
  appendNumber(text, rgb[0]);
  text += ' ';
  appendNumber(text, rgb[1]);
  text += ' ';
  appendNumber(text, rgb[2]);
  text += '\n';
}

void appendNodes(std::string& text, std::span<const float> rgba) {
  text.reserve(text.size() + rgba.size() * 8);
  for (std::size_t at = 0; at < rgba.size(); at += 4) {
    appendNode(text, rgba.data() + at);
  }
}

}  // namespace

std::string iridasCubeText(std::span<const float> rgba, int size, const LutDescription& description) {
  std::string title = description.name;
  for (char& c : title) {
    c = c == '"' ? '\'' : c;
  }
  std::string text = "TITLE \"" + title + "\"\n";
  appendComments(text, description);
  text += "LUT_3D_SIZE " + std::to_string(size) + "\nDOMAIN_MIN 0 0 0\nDOMAIN_MAX 1 1 1\n";
  appendNodes(text, rgba);
  return text;
}

std::string resolveCubeText(std::span<const float> shaperCurve, std::span<const float> rgba, int size,
                            const LutDescription& description) {
  std::string text = "# " + description.name + "\n";
  appendComments(text, description);
  if (!shaperCurve.empty()) {
    text += "LUT_1D_SIZE " + std::to_string(shaperCurve.size() / 4) + "\nLUT_1D_INPUT_RANGE 0.0 1.0\n";
  }
  text += "LUT_3D_SIZE " + std::to_string(size) + "\nLUT_3D_INPUT_RANGE 0.0 1.0\n";
  appendNodes(text, shaperCurve);
  appendNodes(text, rgba);
  return text;
}

std::string spi3dText(std::span<const float> rgba, int size) {
  const std::string side = std::to_string(size);
  std::string text = "SPILUT 1.0\n3 3\n" + side + ' ' + side + ' ' + side + '\n';
  const auto count = static_cast<std::size_t>(size);
  for (std::size_t red = 0; red < count; ++red) {
    for (std::size_t green = 0; green < count; ++green) {
      for (std::size_t blue = 0; blue < count; ++blue) {
        text += std::to_string(red) + ' ' + std::to_string(green) + ' ' + std::to_string(blue) + ' ';
        appendNode(text, rgba.data() + 4 * (red + count * (green + count * blue)));
      }
    }
  }
  return text;
}

std::string spi1dText(std::span<const float> rgba) {
  std::string text = "Version 1\nFrom 0.0 1.0\nLength " + std::to_string(rgba.size() / 4) + "\nComponents 3\n{\n";
  appendNodes(text, rgba);
  return text + "}\n";
}

}  // namespace metamer::ocio
