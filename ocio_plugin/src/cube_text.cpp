// SPDX-License-Identifier: Apache-2.0
#include "cube_text.h"

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

void appendNodes(std::string& text, std::span<const float> rgba) {
  text.reserve(text.size() + rgba.size() * 8);
  for (std::size_t at = 0; at < rgba.size(); at += 4) {
    appendNumber(text, rgba[at]);
    text += ' ';
    appendNumber(text, rgba[at + 1]);
    text += ' ';
    appendNumber(text, rgba[at + 2]);
    text += '\n';
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

std::string resolveCubeText(std::span<const float> rgba, int size, const LutDescription& description) {
  std::string text = "# " + description.name + "\n";
  appendComments(text, description);
  text += "LUT_3D_SIZE " + std::to_string(size) + "\nLUT_3D_INPUT_RANGE 0.0 1.0\n";
  appendNodes(text, rgba);
  return text;
}

}  // namespace metamer::ocio
