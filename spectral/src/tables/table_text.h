// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace metamer::spectral {

inline constexpr std::size_t kMostTableRows = 1'000'000;
inline constexpr std::size_t kMostTableColumns = 10'000;

/// Cells may be separated by any white space.
inline constexpr char kWhiteSpaceSeparator = ' ';

/// A line that holds something.
struct TableLine {
  std::size_t number = 0;  ///< from 1
  std::string_view text;   ///< without white space at its ends, and without the mark where it is a comment
  bool isComment = false;  ///< began with # ; // % or !
};

/// A table's text in lines, its separator known. The text must outlive it.
struct TableText {
  std::string where;  ///< what messages call the file
  std::vector<TableLine> lines;
  char separator = kWhiteSpaceSeparator;

  /// "lamp.csv:12"
  std::string at(const TableLine& line) const { return where + ":" + std::to_string(line.number); }
};

/// Splits text in any of the three line endings. The separator is what `sep=` says (a first line that spreadsheets
/// read), or what separates the first line that begins with a wavelength: semicolon, tab, comma or white space. A comma
/// between digits is decimal where white space separates.
TableText tableText(std::string_view text, const std::string& where);

/// The cells of a line, outer white space and quotes' commas aside; quotes themselves stay. Empty cells are kept, also
/// at the end: "380,0.5," has three. What follows " #" or " //" after numbers is a comment.
/// @throws InputError for more than kMostTableColumns
std::vector<std::string_view> cellsOf(const TableLine& line, const TableText& text);

/// A cell without its quotes.
std::string unquoted(std::string_view cell);

/// A cell as a number, a decimal comma read as a point where commas do not separate.
std::optional<double> cellNumber(std::string_view cell, char separator);

/// Whether a cell begins as a number does, "nan" included: what is to be read as one, or reported.
bool beginsLikeNumber(std::string_view cell);

}  // namespace metamer::spectral
