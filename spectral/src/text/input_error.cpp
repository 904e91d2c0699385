// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/input_error.h"

#include "metamer/spectral/text.h"

namespace metamer::spectral {
namespace {

constexpr std::size_t kLongestValue = 60;

std::string message(const std::string& where, const std::string& field, const std::string& value,
                    const std::string& remedy) {
  std::string subject = oneLine(field);
  if (!value.empty()) {
    if (!subject.empty()) {
      subject += ' ';
    }
    subject += "'" + shortened(oneLine(value), kLongestValue) + "'";
  }
  std::string result = oneLine(where);
  for (const std::string& part : {subject, oneLine(remedy)}) {
    if (part.empty()) {
      continue;
    }
    if (!result.empty()) {
      result += ": ";
    }
    result += part;
  }
  return result;
}

}  // namespace

InputError::InputError(const std::string& where, const std::string& field, const std::string& value,
                       const std::string& remedy)
    : std::runtime_error(message(where, field, value, remedy)) {}

}  // namespace metamer::spectral
