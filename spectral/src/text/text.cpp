// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/text.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <system_error>

#include "metamer/spectral/input_error.h"

namespace metamer::spectral {
namespace {

constexpr std::string_view kWhiteSpace = " \t\r\n\f\v";

bool isContinuation(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

/// Length of the well-formed character (RFC 3629) at the start of `text`, 0 where there is none.
std::size_t characterLength(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80U) {
    return 1;
  }
  const std::size_t length = first >= 0xF0U ? 4 : first >= 0xE0U ? 3 : 2;
  if (first < 0xC2U || first > 0xF4U || text.size() < length) {
    return 0;
  }
  for (std::size_t i = 1; i < length; ++i) {
    if (!isContinuation(text[i])) {
      return 0;
    }
  }
  // Overlong forms, surrogates and code points above U+10FFFF.
  const bool bad = (first == 0xE0U && byte(1) < 0xA0U) || (first == 0xEDU && byte(1) >= 0xA0U) ||
                   (first == 0xF0U && byte(1) < 0x90U) || (first == 0xF4U && byte(1) >= 0x90U);
  return bad ? 0 : length;
}

/// Eight ASCII bytes without a NUL are stepped over at once: files of tens of megabytes are checked in milliseconds.
bool eightPlainBytes(const char* bytes) {
  std::uint64_t word = 0;
  std::memcpy(&word, bytes, sizeof word);
  constexpr std::uint64_t kHighBits = 0x8080808080808080U;
  constexpr std::uint64_t kOnes = 0x0101010101010101U;
  return ((word | (word - kOnes)) & kHighBits) == 0;
}

/// How many bytes from the start are UTF-8 without a NUL.
std::size_t plainUtf8Length(std::string_view text) {
  std::size_t position = 0;
  while (position < text.size()) {
    if (text.size() - position >= 8 && eightPlainBytes(text.data() + position)) {
      position += 8;
      continue;
    }
    const std::size_t length = text[position] == '\0' ? 0 : characterLength(text.substr(position));
    if (length == 0) {
      break;
    }
    position += length;
  }
  return position;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kWhiteSpace);
  if (first == std::string_view::npos) {
    return {};
  }
  return text.substr(first, text.find_last_not_of(kWhiteSpace) - first + 1);
}

std::string lowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') {
      c = static_cast<char>(c - 'A' + 'a');
    }
  }
  return lower;
}

std::string oneLine(std::string_view text) {
  std::string line(text);
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < 0x20U || c == 0x7F) {
      c = ' ';
    }
  }
  return line;
}

std::string shortened(const std::string& text, std::size_t most) {
  constexpr std::string_view kMark = "...";
  if (text.size() <= most) {
    return text;
  }
  std::size_t end = most - kMark.size();
  while (end > 0 && isContinuation(text[end])) {
    --end;
  }
  return text.substr(0, end).append(kMark);
}

std::string shortestNumber(double value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  return {digits.data(), end.ptr};
}

std::string threeDigits(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return text.data();
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    text += (text.empty() ? "" : ", ") + word;
  }
  return text;
}

std::string numberText(double value) {
  std::array<char, 32> buffer{};
  char* const end = buffer.data() + buffer.size();
  // Temperatures and wavelengths as people write them: 100000, not 1e+05.
  const bool plain = std::abs(value) >= 1e-3 && std::abs(value) < 1e15;
  const auto result = plain ? std::to_chars(buffer.data(), end, value, std::chars_format::fixed)
                            : std::to_chars(buffer.data(), end, value);
  return {buffer.data(), result.ptr};
}

std::optional<double> parseNumber(std::string_view token) {
  token = trimmed(token);
  // from_chars takes no plus sign, and takes "nan" and "inf".
  if (token.size() > 1 && token.front() == '+' && token[1] != '-') {
    token.remove_prefix(1);
  }
  double value = 0;
  const char* const end = token.data() + token.size();
  const auto result = std::from_chars(token.data(), end, value);
  if (token.empty() || result.ec != std::errc() || result.ptr != end || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

bool isNotFinite(std::string_view token) {
  token = trimmed(token);
  if (!token.empty() && (token.front() == '+' || token.front() == '-')) {
    token.remove_prefix(1);
  }
  const std::string lower = lowerCase(token);
  return lower == "nan" || lower == "inf" || lower == "infinity";
}

bool isUtf8(std::string_view text) {
  return plainUtf8Length(text) == text.size();
}

std::string_view checkedUtf8(std::string_view text, const std::string& where) {
  constexpr std::string_view kRemedy = "save the file as UTF-8";
  const auto startsWith = [&](std::string_view mark) { return text.substr(0, mark.size()) == mark; };
  if (startsWith("\xFF\xFE") || startsWith("\xFE\xFF")) {
    throw InputError(where, "text encoding", "UTF-16", std::string(kRemedy));
  }
  if (startsWith("\xEF\xBB\xBF")) {
    text.remove_prefix(3);
  }
  const std::size_t position = plainUtf8Length(text);
  if (position < text.size()) {
    const std::string what = text[position] == '\0' ? " is NUL: UTF-16 or not text; " : " is not UTF-8 (Latin-1?); ";
    throw InputError(where, "text encoding", "", "byte " + std::to_string(position + 1) + what + std::string(kRemedy));
  }
  return text;
}

}  // namespace metamer::spectral
