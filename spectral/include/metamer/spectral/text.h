// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace metamer::spectral {

/// Without white space (space, tab, CR, LF, form feed, vertical tab) at either end.
std::string_view trimmed(std::string_view text);

/// ASCII letters in lower case; other bytes stay.
std::string lowerCase(std::string_view text);

/// Control characters become spaces, so that a message stays on one line.
std::string oneLine(std::string_view text);

/// At most `most` bytes, cut between characters and marked with "..." where cut.
std::string shortened(const std::string& text, std::size_t most);

/// The shorter of decimal and exponent form that reads back as the same number: for files.
std::string shortestNumber(double value);

/// Shortest decimal form that reads back as the same number, without an exponent for ordinary sizes: for messages.
std::string numberText(double value);

/// Three significant digits: for figures and messages.
std::string threeDigits(double value);

/// With a comma and a space between.
std::string joined(const std::vector<std::string>& words);

/// A whole token, white space round it aside, as a number in decimal notation, independent of the locale. Empty where
/// the token is anything else: text after the number, hexadecimal, "nan", "inf", out of the range of double.
std::optional<double> parseNumber(std::string_view token);

/// True for "nan", "inf" and "infinity" with or without a sign: a number to other programs, refused here by name.
bool isNotFinite(std::string_view token);

/// Whether the text is UTF-8 without a NUL.
bool isUtf8(std::string_view text);

/// The text without a UTF-8 byte order mark.
/// @throws InputError where it is UTF-16 or UTF-32, holds a NUL, or is not UTF-8
std::string_view checkedUtf8(std::string_view text, const std::string& where);

}  // namespace metamer::spectral
