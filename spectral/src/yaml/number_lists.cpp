// SPDX-License-Identifier: Apache-2.0
#include "yaml/number_lists.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <utility>

namespace metamer::spectral {
namespace {

/// Round the number of a list: a character for private use.
constexpr std::string_view kMark = "\xEE\x80\x80";
/// Shorter ones are left to the parser.
constexpr std::size_t kFewest = 3;

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

/// A place in the document.
struct Cursor {
  std::string_view text;
  std::size_t at = 0;
  int line = 0;
  std::size_t lineStart = 0;

  char here() const { return at < text.size() ? text[at] : '\0'; }
  int column() const { return static_cast<int>(at - lineStart); }
  void skipBlank() {
    for (; here() == ' ' || here() == '\n'; ++at) {
      if (here() == '\n') {
        ++line;
        lineStart = at + 1;
      }
    }
  }
  /// A sign at most, then what numbers are written with. @return empty where there is no number
  std::string_view number() {
    const std::size_t begin = at;
    const std::size_t first = here() == '-' || here() == '+' ? begin + 1 : begin;
    const std::size_t digit = first < text.size() && text[first] == '.' ? first + 1 : first;
    if (digit >= text.size() || !isDigit(text[digit])) {
      return {};
    }
    const std::size_t end = text.find_first_not_of("0123456789.eE+-", digit);
    at = std::min(end, text.size());
    return text.substr(begin, at - begin);
  }
};

/// The list that begins at the cursor, which is then behind it. Nothing where it is none, or a short one.
std::optional<NumberList> listAt(Cursor& cursor) {
  NumberList list;
  do {
    ++cursor.at;  // the bracket or a comma
    cursor.skipBlank();
    const auto [line, column] = std::pair(cursor.line, cursor.column());
    const std::string_view number = cursor.number();
    if (number.empty()) {
      return std::nullopt;
    }
    list.numbers.push_back({number, line, column});
    cursor.skipBlank();
  } while (cursor.here() == ',');
  if (cursor.here() != ']' || list.numbers.size() < kFewest) {
    return std::nullopt;
  }
  ++cursor.at;
  list.lastLine = cursor.line;
  return list;
}

}  // namespace

const NumberList* ShortenedText::find(std::string_view word) const {
  if (word.size() <= 2 * kMark.size() || !word.starts_with(kMark) || !word.ends_with(kMark)) {
    return nullptr;
  }
  const std::string_view digits = word.substr(kMark.size(), word.size() - 2 * kMark.size());
  std::size_t index = 0;
  const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  const bool isNumber = parsed.ec == std::errc() && parsed.ptr == digits.data() + digits.size();
  return isNumber && index < lists.size() ? &lists[index] : nullptr;
}

bool ShortenedText::isMarked(std::string_view text) {
  return text.find(kMark) != std::string_view::npos;
}

std::optional<ShortenedText> withoutNumberLists(std::string_view document) {
  if (ShortenedText::isMarked(document)) {
    return std::nullopt;
  }
  ShortenedText shortened;
  std::string& text = shortened.text;
  Cursor cursor{document};
  std::size_t copied = 0;
  std::size_t lineStart = 0;  // in the shortened text
  for (std::size_t next = document.find('['); next != std::string_view::npos; next = document.find('[', cursor.at)) {
    while (cursor.at < next) {  // counts lines
      const std::size_t lineEnd = document.find('\n', cursor.at);
      if (lineEnd >= next) {
        break;
      }
      cursor.at = cursor.lineStart = lineEnd + 1;
      ++cursor.line;
    }
    cursor.at = next;
    const int firstLine = cursor.line;
    const std::size_t firstStart = cursor.lineStart;
    const bool inComment = document.substr(firstStart, next - firstStart).find('#') != std::string_view::npos;
    std::optional<NumberList> list = inComment ? std::nullopt : listAt(cursor);
    if (!list) {
      cursor = {document, next + 1, firstLine, firstStart};
      continue;
    }
    if (firstStart > copied || text.empty()) {
      lineStart = text.size() + firstStart - copied;
    }
    text.append(document.substr(copied, next - copied));
    text.append(kMark).append(std::to_string(shortened.lists.size())).append(kMark);
    if (list->lastLine > firstLine) {
      text.append(static_cast<std::size_t>(list->lastLine - firstLine), '\n');
      lineStart = text.size();
      text.push_back(' ');  // nothing but keys of the outermost map stands at a line's beginning
    }
    list->shift = cursor.column() - static_cast<int>(text.size() - lineStart);
    copied = cursor.at;
    shortened.lists.push_back(std::move(*list));
  }
  if (shortened.lists.empty()) {
    return std::nullopt;
  }
  text.append(document.substr(copied));
  return shortened;
}

}  // namespace metamer::spectral
