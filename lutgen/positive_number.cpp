// SPDX-License-Identifier: Apache-2.0
#include "positive_number.h"

#include <string>

namespace metamer::lutgen {

CLI::Validator positiveNumber() {
  const auto complaint = [](const std::string& text) -> std::string {
    double value = 0;
    if (!CLI::detail::lexical_cast(text, value)) {
      return "'" + text + "' is no number; give one above 0";
    }
    return value <= 0 ? "'" + text + "' is too small; give a number above 0" : std::string();
  };
  return {complaint, "POSITIVE"};
}

}  // namespace metamer::lutgen
