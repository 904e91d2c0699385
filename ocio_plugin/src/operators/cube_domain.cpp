// SPDX-License-Identifier: Apache-2.0
#include "operators/cube_domain.h"

#include <cctype>
#include <limits>
#include <sstream>
#include <vector>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/text.h"

namespace metamer::ocio {
namespace {

using spectral::InputError;

/// The numbers of a .cube's line that begins with a keyword, before its table; empty without it.
std::string lineOfCube(const std::string& text, const std::string& keyword) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    line = spectral::trimmed(line);
    if (line.rfind(keyword, 0) == 0 && line.size() > keyword.size() &&
        std::isspace(static_cast<unsigned char>(line[keyword.size()])) != 0) {
      return std::string(spectral::trimmed(line.substr(keyword.size())));
    }
    if (!line.empty() && (std::isdigit(static_cast<unsigned char>(line[0])) != 0 || line[0] == '-')) {
      break;
    }
  }
  return "";
}

std::vector<double> numbersOf(const std::string& text) {
  std::vector<double> numbers;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    numbers.push_back(spectral::parseNumber(word).value_or(std::numeric_limits<double>::quiet_NaN()));
  }
  return numbers;
}

}  // namespace

void refuseOddDomain(const std::filesystem::path& file, const std::string& text) {
  const auto refuse = [&](const char* field, const std::string& value, const std::string& remedy) {
    throw InputError(spectral::utf8(file), field, value, remedy);
  };
  const std::string low = lineOfCube(text, "DOMAIN_MIN");
  const std::string high = lineOfCube(text, "DOMAIN_MAX");
  const std::vector<double> from = low.empty() ? std::vector<double>{0, 0, 0} : numbersOf(low);
  const std::vector<double> to = high.empty() ? std::vector<double>{1, 1, 1} : numbersOf(high);
  for (std::size_t k = 0; k < from.size() && k < to.size(); ++k) {
    if (!(from[k] < to[k]) && !(low.empty() && high.empty())) {
      refuse("DOMAIN_MIN", low.empty() ? "0 0 0" : low,
             "must be numbers below DOMAIN_MAX (" + (high.empty() ? "1 1 1" : high) + "), each; export the LUT again");
    }
  }
  for (const char* keyword : {"LUT_1D_INPUT_RANGE", "LUT_3D_INPUT_RANGE"}) {
    const std::string range = lineOfCube(text, keyword);
    const std::vector<double> ends = numbersOf(range);
    if (ends.size() == 2 && !(ends[0] < ends[1])) {
      refuse(keyword, range, "must be two rising numbers; export the LUT again");
    }
  }
}

}  // namespace metamer::ocio
