// SPDX-License-Identifier: Apache-2.0
#include "config/short_tables.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace metamer::ocio {
namespace {

constexpr double kRounding = 1e5;

/// The shortest text of a number rounded, without a zero before the point.
std::string shortNumber(double value) {
  const double rounded = std::round(value * kRounding) / kRounding;
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), rounded, std::chars_format::fixed).ptr;
  std::string text(digits.data(), end);
  if (const std::size_t zero = text.find("0."); zero == 0 || (zero == 1 && text[0] == '-')) {
    text.erase(zero, 1);
  }
  return rounded == 0.0 ? "0" : text;
}

std::string shortLine(const std::string& line) {
  std::string result;
  const char* at = line.data();
  const char* const end = at + line.size();
  while ((at = std::find_if(at, end, [](char c) { return c != ' ' && c != '\n'; })) != end) {
    double value = 0.0;
    const auto read = std::from_chars(at, end, value);
    if (read.ec != std::errc{}) {
      return line;
    }
    result += (result.empty() ? "" : " ") + shortNumber(value);
    at = read.ptr;
  }
  return result + "\n";
}

}  // namespace

std::string shortTables(const std::string& ctf) {
  std::string result;
  bool isTable = false;
  bool isArray = false;
  for (std::size_t begin = 0; begin < ctf.size();) {
    const std::size_t end = std::min(ctf.find('\n', begin), ctf.size() - 1) + 1;
    const std::string line = ctf.substr(begin, end - begin);
    isArray = isArray && line.find("</Array>") == std::string::npos;
    result += isTable && isArray ? shortLine(line) : line;
    if (line.find("<LUT1D") != std::string::npos || line.find("<LUT3D") != std::string::npos) {
      isTable = true;
    } else if (line.find("</LUT1D>") != std::string::npos || line.find("</LUT3D>") != std::string::npos) {
      isTable = false;
    }
    isArray = isArray || line.find("<Array") != std::string::npos;
    begin = end;
  }
  return result;
}

}  // namespace metamer::ocio
