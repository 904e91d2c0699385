// SPDX-License-Identifier: Apache-2.0
#include "tables/table_text.h"

#include <algorithm>
#include <utility>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"
#include "tables/wavelength_cell.h"

namespace metamer::spectral {
namespace {

/// What stands before a table and after it.
constexpr std::size_t kMostOtherLines = 10'000;

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

/// The text behind the mark of a comment, or nothing where the line is none.
std::optional<std::string_view> comment(std::string_view line) {
  for (const std::string_view mark : {"//", "#", ";", "%", "!"}) {
    if (line.substr(0, mark.size()) == mark) {
      return trimmed(line.substr(std::min(line.find_first_not_of(mark.front()), line.size())));
    }
  }
  return std::nullopt;
}

/// What a first line "sep=;" says.
std::optional<char> statedSeparator(std::string_view line) {
  if (lowerCase(line.substr(0, 4)) != "sep=" || line.size() > 5) {
    return std::nullopt;
  }
  // A tab was trimmed away.
  return line.size() == 5 ? line[4] : '\t';
}

/// "380 0,5": the comma belongs to a number where white space separates the cells and touches no comma.
bool commasAreDecimal(std::string_view line) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == ',' && (i == 0 || i + 1 == line.size() || !isDigit(line[i - 1]) || !isDigit(line[i + 1]))) {
      return false;
    }
  }
  return line.find(' ') != std::string_view::npos;
}

/// "380,<tab>0.5": tabs that only pad what commas separate, or stand at the line's end.
bool tabsArePadding(std::string_view line) {
  line = trimmed(line);
  for (std::size_t tab = line.find('\t'); tab != std::string_view::npos; tab = line.find('\t', tab + 1)) {
    const std::size_t before = line.find_last_not_of(" \t", tab);
    const std::size_t behind = line.find_first_not_of(" \t", tab);
    if (line[before] != ',' && line[behind] != ',') {
      return false;
    }
  }
  return line.find(',') != std::string_view::npos;
}

char separatorOf(std::string_view line) {
  if (line.find(';') != std::string_view::npos) {
    return ';';
  }
  if (line.find('\t') != std::string_view::npos && !tabsArePadding(line)) {
    return '\t';
  }
  // The white space of "Spectral Data 380[nm],0,5" separates nothing.
  const bool hasComma = line.find(',') != std::string_view::npos;
  return hasComma && !(beginsLikeNumber(line) && commasAreDecimal(line)) ? ',' : kWhiteSpaceSeparator;
}

/// Whether a line begins with a wavelength, whatever separates.
bool beginsWithWavelength(std::string_view line) {
  const std::string cell = unquoted(trimmed(line.substr(0, line.find_first_of(",;\t"))));
  const std::string_view word = std::string_view(cell).substr(0, cell.find(' '));
  return wavelengthCell(cell, ';') || wavelengthCell(word, ';');
}

/// Among the first lines: the one that tells what separates.
char findSeparator(const std::vector<TableLine>& lines) {
  const TableLine* wide = nullptr;
  std::size_t mostCells = 0;
  for (const TableLine& line : lines) {
    if (line.isComment) {
      continue;
    }
    const char separator = separatorOf(line.text);
    const bool hasCells = line.text.find(separator) != std::string_view::npos;
    if (beginsWithWavelength(line.text) && hasCells) {
      return separator;
    }
    // Curves in rows have no such line: then the widest.
    const auto count = static_cast<std::size_t>(std::count(line.text.begin(), line.text.end(), separator));
    if (count > mostCells) {
      mostCells = count;
      wide = &line;
    }
  }
  return wide == nullptr ? kWhiteSpaceSeparator : separatorOf(wide->text);
}

std::size_t endOfQuotes(std::string_view text) {
  std::size_t i = 1;
  while (i < text.size()) {
    if (text[i] == '"' && (i + 1 == text.size() || text[i + 1] != '"')) {
      return i + 1;
    }
    i += text[i] == '"' ? 2 : 1;
  }
  return text.size();
}

/// A row of numbers without a comment at its end.
std::string_view withoutComment(std::string_view line) {
  if (!beginsLikeNumber(line)) {
    return line;
  }
  std::size_t end = line.size();
  for (const std::string_view mark : {" #", "\t#", ",#", " //", "\t//", " !", " %"}) {
    // "50 %" is no comment.
    const std::size_t at = line.find(mark);
    const bool isWord = at != std::string_view::npos && (mark != " %" || at + 2 < line.size());
    end = isWord ? std::min(end, at) : end;
  }
  return trimmed(line.substr(0, end));
}

}  // namespace

TableText tableText(std::string_view text, const std::string& where) {
  TableText table;
  table.where = where;
  std::optional<char> stated;
  // A comment, or a row whose first cell is empty: the separator tells.
  std::vector<std::pair<std::size_t, std::string_view>> semicolons;
  std::size_t number = 0;
  while (!text.empty()) {
    ++number;
    const std::size_t end = text.find_first_of("\r\n");
    const std::string_view whole = text.substr(0, end);
    const bool crLf = end != std::string_view::npos && text.substr(end, 2) == "\r\n";
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + (crLf ? 2 : 1));
    const std::string_view line = trimmed(whole);
    if (line.empty()) {
      continue;
    }
    if (const auto separator = statedSeparator(line); separator && table.lines.empty()) {
      stated = separator;
      continue;
    }
    if (table.lines.size() > kMostTableRows + kMostOtherLines) {
      throw InputError(where, "rows", "", "more than one million; resample to a wider interval");
    }
    const std::optional<std::string_view> remark = comment(line);
    if (line.front() == ';') {
      semicolons.push_back({table.lines.size(), line});
    }
    // Tabs at the ends stand before and behind empty cells.
    const std::string_view kept = whole.substr(std::min(whole.find_first_not_of(' '), whole.size()));
    table.lines.push_back({number, remark ? *remark : kept, remark.has_value()});
  }
  table.separator = stated.value_or(findSeparator(table.lines));
  for (const auto& [index, line] : semicolons) {
    if (table.separator == ';') {
      table.lines[index] = {table.lines[index].number, line, false};
    }
  }
  return table;
}

std::vector<std::string_view> cellsOf(const TableLine& line, const TableText& text) {
  std::vector<std::string_view> cells;
  std::string_view rest = withoutComment(text.separator == kWhiteSpaceSeparator ? trimmed(line.text) : line.text);
  const bool isWhite = text.separator == kWhiteSpaceSeparator;
  while (true) {
    if (cells.size() > kMostTableColumns) {
      throw InputError(text.at(line), "columns", "",
                       "more than " + std::to_string(kMostTableColumns) + "; split the file");
    }
    const std::size_t from = !rest.empty() && rest.front() == '"' ? endOfQuotes(rest) : 0;
    const std::size_t end = isWhite ? rest.find_first_of(" \t\f\v", from) : rest.find(text.separator, from);
    cells.push_back(trimmed(rest.substr(0, end)));
    if (end == std::string_view::npos) {
      return cells;
    }
    rest = isWhite ? trimmed(rest.substr(end)) : rest.substr(end + 1);
    while (!isWhite && !rest.empty() && (rest.front() == ' ' || (rest.front() == '\t' && text.separator != '\t'))) {
      rest.remove_prefix(1);
    }
  }
}

std::string unquoted(std::string_view cell) {
  if (cell.size() < 2 || cell.front() != '"' || cell.back() != '"') {
    return std::string(cell);
  }
  std::string text;
  cell = cell.substr(1, cell.size() - 2);
  for (std::size_t i = 0; i < cell.size(); ++i) {
    text += cell[i];
    if (cell[i] == '"' && i + 1 < cell.size() && cell[i + 1] == '"') {
      ++i;
    }
  }
  return std::string(trimmed(text));
}

std::optional<double> cellNumber(std::string_view cell, char separator) {
  if (cell.size() >= 2 && cell.front() == '"') {
    return parseNumber(unquoted(cell));
  }
  if (separator == ',' || cell.find(',') == std::string_view::npos) {
    return parseNumber(cell);
  }
  std::string pointed(cell);
  std::replace(pointed.begin(), pointed.end(), ',', '.');
  return parseNumber(pointed);
}

bool beginsLikeNumber(std::string_view cell) {
  cell = trimmed(cell);
  if (!cell.empty() && cell.front() == '"') {
    cell = trimmed(cell.substr(1));
  }
  if (isNotFinite(cell.substr(0, cell.find_first_of(",;\t \"")))) {
    return true;
  }
  if (!cell.empty() && (cell.front() == '-' || cell.front() == '+')) {
    cell.remove_prefix(1);
  }
  if (!cell.empty() && cell.front() == '.') {
    cell.remove_prefix(1);
  }
  return !cell.empty() && isDigit(cell.front());
}

}  // namespace metamer::spectral
