// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace metamer::spectral {

/// A list of plain numbers between brackets, taken out of a document's text.
struct NumberList {
  struct Number {
    std::string_view text;  ///< as it is written
    int line;               ///< from 0, as columns, which count bytes
    int column;
  };
  std::vector<Number> numbers;
  int lastLine = 0;  ///< the line with the closing bracket
  int shift = 0;     ///< of columns behind it there: those of the document less those of the shortened text
};

/// A document whose long lists of plain numbers are one word each: a parser that looks at every character many times
/// then reads a scene with a thousand spectra at once. Lines are those of the document.
struct ShortenedText {
  std::string text;
  std::vector<NumberList> lists;  ///< in their order; views into the document

  /// The list that a word of the text stands for, nothing where it is no such word.
  const NumberList* find(std::string_view word) const;
  /// Whether a text holds such a word, or a part of it.
  static bool isMarked(std::string_view text);
};

/// What looks like a list of numbers need not be one: in a comment or in quotes it is text. Whoever parses the
/// shortened text takes the document itself where a word turns up as anything but a value, or does not turn up.
/// @return nothing where there is no such list, or the document holds the words' mark already
std::optional<ShortenedText> withoutNumberLists(std::string_view document);

}  // namespace metamer::spectral
