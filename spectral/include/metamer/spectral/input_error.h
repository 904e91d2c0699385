// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace metamer::spectral {

/// Bad input from outside: a file, a recipe, a name, a number, an argument out of its documented range.
///
/// `what()` is one line: "WHERE: FIELD 'VALUE': REMEDY". Parts that do not apply are left out.
/// Programmer faults are assertions, never this.
class InputError : public std::runtime_error {
 public:
  /// @param where   file (with line or column where known) or command-line flag
  /// @param field   what was being read, in the user's words
  /// @param value   the offending value as given, shortened to 60 characters
  /// @param remedy  what is wrong and what to do about it
  InputError(const std::string& where, const std::string& field, const std::string& value, const std::string& remedy);
};

}  // namespace metamer::spectral
