// SPDX-License-Identifier: Apache-2.0
#include "files/column_choice.h"

#include <cmath>
#include <optional>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"

namespace metamer::spectral {

std::size_t columnIndex(const std::string& column, const std::vector<std::string>& names, const std::string& file) {
  const std::string wanted = lowerCase(trimmed(column));
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (lowerCase(names[i]) == wanted) {
      if (found) {
        throw InputError(file, "column", column, "is the name of several; give the number of one, from 1");
      }
      found = i;
    }
  }
  const std::optional<double> number = parseNumber(wanted);
  if (!found && number && *number >= 1 && *number <= static_cast<double>(names.size()) &&
      *number == std::floor(*number)) {
    found = static_cast<std::size_t>(*number) - 1;
  }
  if (!found) {
    throw InputError(file, "column", column,
                     "is not there; give a name or a number from 1 of: " + listedColumns(names));
  }
  return *found;
}

std::string listedColumns(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 12;
  std::vector<std::string> listed;
  for (const std::string& name : names) {
    if (listed.size() == kMost) {
      listed.push_back("... " + std::to_string(names.size()) + " in all");
      break;
    }
    listed.push_back(shortened(name, 24));
  }
  return joined(listed);
}

}  // namespace metamer::spectral
