// SPDX-License-Identifier: Apache-2.0
#include "config/short_tables.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <pugixml.hpp>

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
  pugi::xml_document document;
  if (!document.load_buffer(ctf.data(), ctf.size(), pugi::parse_minimal | pugi::parse_fragment, pugi::encoding_utf8)) {
    return ctf;
  }
  // Only the lines of numbers change: everything round them stays as OpenColorIO wrote it.
  pugi::xpath_node_set arrays = document.select_nodes("//LUT1D/Array/text() | //LUT3D/Array/text()");
  arrays.sort();
  std::string result;
  std::size_t done = 0;
  for (const pugi::xpath_node& array : arrays) {
    const auto text = static_cast<std::size_t>(array.node().offset_debug());
    // Whole lines: the first ends the opening tag, the last begins with the closing one.
    const std::size_t begin = ctf.find('\n', text) + 1;
    const std::size_t end = ctf.rfind('\n', ctf.find('<', text)) + 1;
    result.append(ctf, done, begin - done);
    for (done = begin; done < end;) {
      const std::size_t next = ctf.find('\n', done) + 1;
      result += shortLine(ctf.substr(done, next - done));
      done = next;
    }
  }
  return result.append(ctf, done);
}

}  // namespace metamer::ocio
