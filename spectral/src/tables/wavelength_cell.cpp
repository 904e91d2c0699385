// SPDX-License-Identifier: Apache-2.0
#include "tables/wavelength_cell.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "metamer/spectral/text.h"
#include "tables/table_text.h"

namespace metamer::spectral {
namespace {

constexpr double kShortestLabelledNm = 100;
constexpr double kLongestLabelledNm = 5000;

// The two code points of the micro sign, and both letter cases of the ring A with the Angstrom sign.
constexpr std::array<std::string_view, 9> kMicrometre{
    "um", "\u00b5m", "\u03bcm", "micrometre", "micrometer", "micrometres", "micrometers", "micron", "microns"};
constexpr std::array<std::string_view, 5> kAngstrom{"angstrom", "angstroms", "\u00c5", "\u00e5", "\u212b"};
constexpr std::array<std::string_view, 5> kNanometre{"nm", "nanometre", "nanometer", "nanometres", "nanometers"};

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

/// True where one of the words of `text` (runs of letters, any script) is `word`.
bool hasWord(std::string_view text, std::string_view word) {
  const auto isLetter = [](char c) {
    return std::isalpha(static_cast<unsigned char>(c)) != 0 || static_cast<unsigned char>(c) >= 0x80U;
  };
  for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || !isLetter(text[at - 1])) && (end == text.size() || !isLetter(text[end]))) {
      return true;
    }
  }
  return false;
}

template <typename Words>
bool hasOneOf(std::string_view text, const Words& words) {
  return std::any_of(words.begin(), words.end(), [&](std::string_view word) { return hasWord(text, word); });
}

/// "[nm]" and "(nm)" as "nm".
std::string_view unbracketed(std::string_view text) {
  text = trimmed(text);
  const bool isBracketed =
      text.size() >= 2 && ((text.front() == '[' && text.back() == ']') || (text.front() == '(' && text.back() == ')') ||
                           (text.front() == '<' && text.back() == '>'));
  return isBracketed ? trimmed(text.substr(1, text.size() - 2)) : text;
}

/// The unit that a text is, 0 where it is none.
double unitOf(const std::string& text) {
  const auto is = [&](const auto& words) { return std::find(words.begin(), words.end(), text) != words.end(); };
  return is(kNanometre) ? 1.0 : is(kMicrometre) ? 1000.0 : is(kAngstrom) ? 0.1 : 0.0;
}

}  // namespace

std::optional<WavelengthCell> wavelengthCell(std::string_view quotedCell, char separator) {
  const std::string cell = unquoted(quotedCell);
  if (const std::optional<double> number = cellNumber(cell, separator)) {
    return WavelengthCell{*number, 0, false};
  }
  const std::size_t first = cell.find_first_of("0123456789");
  if (first == std::string::npos) {
    return std::nullopt;
  }
  const std::size_t end = std::min(cell.find_first_not_of("0123456789.,", first), cell.size());
  const std::string label = lowerCase(trimmed(std::string_view(cell).substr(0, first)));
  const std::string rest = lowerCase(unbracketed(std::string_view(cell).substr(end)));
  const std::optional<double> number = cellNumber(std::string_view(cell).substr(first, end - first), separator);
  const double unitBehind = unitOf(rest);
  if (!number || (!rest.empty() && unitBehind == 0) || label.find_first_of("+-.#") != std::string::npos) {
    return std::nullopt;
  }
  // "nm380", "SPECTRAL_NM380"
  const double unit = unitBehind > 0 ? unitBehind : nmPerUnitIn(label);
  const double nm = *number * (unit > 0 ? unit : 1.0);
  if (!label.empty() && !(nm >= kShortestLabelledNm && nm <= kLongestLabelledNm)) {
    return std::nullopt;
  }
  // Behind "sRGB 400" stands no wavelength: a label ends with a sign, a unit, or is a spectrum's own.
  const bool isWord = !label.empty() && unit == 0 && label.back() != '_' && label.find("spec") == std::string::npos;
  return isWord ? std::nullopt : std::optional(WavelengthCell{*number, unit, !label.empty()});
}

double nmPerUnitIn(std::string_view text) {
  const std::string heading = lowerCase(text);
  // A bare letter is a unit in brackets alone, and behind a word for wavelengths.
  const bool isInA = namesWavelength(text) &&
                     (text.find("(A)") != std::string_view::npos || text.find("[A]") != std::string_view::npos);
  return hasOneOf(heading, kMicrometre)          ? 1000.0
         : isInA || hasOneOf(heading, kAngstrom) ? 0.1
         : hasOneOf(heading, kNanometre)         ? 1.0
                                                 : 0.0;
}

bool namesWavelength(std::string_view text) {
  // English, German, French, Italian and Spanish, Japanese and Chinese; symbols.
  constexpr std::array<std::string_view, 12> kParts{
      "wavelength", "wave length", "wellenl", "longueur d'onde",     "lunghezza d'onda", "longitud de onda", "lambda",
      "\u03bb",     "\u6ce2",      "wvl",     "comprimento de onda", "golflengte"};
  const std::string heading = lowerCase(text);
  return hasWord(heading, "wl") || hasOneOf(heading, kNanometre) ||
         std::any_of(kParts.begin(), kParts.end(),
                     [&](std::string_view part) { return heading.find(part) != std::string::npos; });
}

bool statesPercent(std::string_view heading) {
  const std::string lower = lowerCase(heading);
  for (const std::string_view mark : {std::string_view("%"), std::string_view("percent")}) {
    const std::size_t at = lower.find(mark);
    if (at == std::string::npos) {
      continue;
    }
    const std::string_view before = trimmed(std::string_view(lower).substr(0, at));
    if (before.empty() || !isDigit(before.back())) {
      return true;
    }
  }
  return false;
}

bool isUnit(std::string_view heading) {
  constexpr std::array<std::string_view, 12> kUnits{"a.u.",     "au",    "arb.", "%",    "percent",  "counts",
                                                    "counts/s", "ratio", "1",    "rel.", "relative", "-"};
  const std::string_view cell = trimmed(heading);
  const std::string lower = lowerCase(cell);
  return cell.empty() || unbracketed(cell).size() < cell.size() || unitOf(lower) > 0 ||
         std::find(kUnits.begin(), kUnits.end(), lower) != kUnits.end() ||
         (cell.find(' ') == std::string_view::npos && cell.find('/') != std::string_view::npos &&
          hasOneOf(lower, kNanometre));
}

}  // namespace metamer::spectral
