// SPDX-License-Identifier: Apache-2.0
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "metamer/sip/band_weights.h"
#include "metamer/sip/pairs.h"
#include "metamer/spectral/colorimetry.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/spectral_integral.h"
#include "metamer/spectral/text.h"
#include "pairs/several_lights.h"

namespace metamer::sip {

namespace {

using Eigen::Index;
using Eigen::Vector3d;
using spectral::InputError;

constexpr int kBandCount = 81;
constexpr const char* kObserver = "CIE 1931 2";
constexpr const char* kHeading = "pair,light,X,Y,Z or pair,light,L*,a*,b*";
/// Of X, Y and Z where the perfect reflector has Y = 1: more is on the scale of 100.
constexpr double kLargest = 2.0;

using Cells = std::vector<std::string>;

Cells cellsOf(const std::string& line) {
  Cells cells(1);
  bool isQuoted = false;
  for (const char c : line) {
    if (c == '"') {
      isQuoted = !isQuoted;
    } else if (!isQuoted && (c == ',' || c == ';' || c == '\t')) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  for (std::string& cell : cells) {
    cell = std::string(spectral::trimmed(cell));
  }
  return cells;
}

/// A line that says something, with its number.
struct Line {
  std::size_t number;
  Cells cells;
};

std::vector<Line> linesOf(std::string_view text) {
  std::vector<Line> lines;
  std::size_t number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string line(spectral::trimmed(text.substr(0, end)));
    text.remove_prefix(std::min(end + 1, text.size()));
    ++number;
    if (!line.empty() && line.front() != '#') {
      lines.push_back({number, cellsOf(line)});
    }
  }
  return lines;
}

enum class Numbers { Xyz, Lab };

/// How a heading's numbers are meant; nothing where the table is no table of colours.
std::optional<Numbers> numbersOf(const Line& heading, const std::string& where) {
  Cells cells = heading.cells;
  for (std::string& cell : cells) {
    cell = spectral::lowerCase(cell);
  }
  if (cells[0] != "pair") {
    return std::nullopt;
  }
  if (cells == Cells{"pair", "light", "x", "y", "z"}) {
    return Numbers::Xyz;
  }
  if (cells == Cells{"pair", "light", "l*", "a*", "b*"} || cells == Cells{"pair", "light", "l", "a", "b"}) {
    return Numbers::Lab;
  }
  throw InputError(where + ":" + std::to_string(heading.number), "heading", spectral::joined(heading.cells),
                   std::string("must be ") + kHeading);
}

struct Light {
  Eigen::Matrix3Xd weights;  ///< XYZ from reflectance
  Vector3d white;
};

Light lightOf(const std::string& name, const spectral::DataLibrary& library, const std::filesystem::path& folder) {
  const spectral::SeenLight seen =
      spectral::seenLight(library.illuminant(name, folder), {}, library.observer(kObserver));
  const Vector3d white = seen.curves.transpose() * seen.light;
  return {bandWeights(seen.light / white.y(), seen.curves, kBandCount), white / white.y()};
}

/// CIELAB's inverse.
Vector3d xyzFromLab(const Vector3d& lab, const Vector3d& white) {
  const double fy = (lab[0] + 16.0) / 116.0;
  const Vector3d f(fy + lab[1] / 500.0, fy, fy - lab[2] / 200.0);
  constexpr double kBend = 6.0 / 29.0;
  return white.cwiseProduct(
      f.unaryExpr([](double t) { return t > kBend ? t * t * t : 3.0 * kBend * kBend * (t - 4.0 / 29.0); }));
}

std::string colourText(const Vector3d& xyz) {
  return spectral::threeDigits(xyz[0]) + " " + spectral::threeDigits(xyz[1]) + " " + spectral::threeDigits(xyz[2]);
}

/// Pairs of a table of colours.
std::vector<Pair> pairsOfColours(const std::vector<Line>& lines, Numbers numbers, const std::string& where,
                                 const spectral::DataLibrary& library, const std::filesystem::path& folder) {
  std::vector<std::pair<std::string, std::vector<PairColour>>> named;
  for (std::size_t k = 1; k < lines.size(); ++k) {
    const auto& [number, cells] = lines[k];
    const std::string row = where + ":" + std::to_string(number);
    if (cells.size() != 5 || cells[0].empty() || cells[1].empty()) {
      throw InputError(row, "row", spectral::joined(cells), std::string("needs five cells, as ") + kHeading);
    }
    Vector3d values;
    for (Index i = 0; i < 3; ++i) {
      const std::string& cell = cells[static_cast<std::size_t>(i + 2)];
      const std::optional<double> value = spectral::parseNumber(cell);
      if (!value) {
        throw InputError(row, lines[0].cells[static_cast<std::size_t>(i + 2)], cell, "must be a finite number");
      }
      values[i] = *value;
    }
    if (numbers == Numbers::Lab) {
      values = xyzFromLab(values, lightOf(cells[1], library, folder).white);
    }
    const auto at =
        std::find_if(named.begin(), named.end(), [&cells = cells](const auto& one) { return one.first == cells[0]; });
    std::vector<PairColour>& colours =
        at == named.end() ? named.emplace_back(cells[0], std::vector<PairColour>{}).second : at->second;
    colours.push_back({cells[1], values});
  }
  std::vector<Pair> pairs;
  for (const auto& [name, colours] : named) {
    pairs.push_back(reflectanceOf(name, colours, library, where, folder));
  }
  return pairs;
}

void checkCount(std::size_t count, const std::string& where) {
  if (count == 0 || count > kMostPairs) {
    throw InputError(where, "pairs", std::to_string(count), "must be from 1 to " + std::to_string(kMostPairs));
  }
}

}  // namespace

Pair reflectanceOf(const std::string& name, const std::vector<PairColour>& colours,
                   const spectral::DataLibrary& library, const std::string& where, const std::filesystem::path& folder,
                   double brightest) {
  if (colours.empty()) {
    throw InputError(where, name, "", "has no colour; give its X, Y, Z under a light");
  }
  const auto count = static_cast<Index>(colours.size());
  Eigen::MatrixXd weights(3 * count, kBandCount);
  Eigen::VectorXd asked(3 * count);
  for (Index k = 0; k < count; ++k) {
    const PairColour& colour = colours[static_cast<std::size_t>(k)];
    if (!(colour.xyz.minCoeff() >= 0.0) || !(colour.xyz.maxCoeff() <= kLargest)) {
      throw InputError(where, name + " under " + colour.light, colourText(colour.xyz),
                       "X, Y and Z must be from 0 to 2, with Y = 1 for the perfect reflector");
    }
    weights.middleRows<3>(3 * k) = lightOf(colour.light, library, folder).weights;
    asked.segment<3>(3 * k) = colour.xyz;
  }
  const SeveralLights solved = smoothestUnder(weights, asked, brightest);
  if (!(solved.missed <= kMetColour)) {
    const Eigen::VectorXd nearest = weights * solved.reflectance;
    std::string text;
    for (Index k = 0; k < count; ++k) {
      text += (k == 0 ? "" : ", ") + colourText(nearest.segment<3>(3 * k)) + " under " +
              colours[static_cast<std::size_t>(k)].light;
    }
    throw InputError(where, name, colourText(asked.head<3>()) + " under " + colours[0].light,
                     (count == 1 ? "no reflectance has this colour; the nearest has X Y Z "
                                 : "no one reflectance has its colours; the nearest has X Y Z ") +
                         text);
  }
  Pair pair{name, {}};
  constexpr int kStep = (spectral::kDomainSize - 1) / (kBandCount - 1);
  for (int nm = 0; nm < spectral::kDomainSize; ++nm) {
    const int band = std::min(nm / kStep, kBandCount - 2);
    const double part = static_cast<double>(nm - band * kStep) / kStep;
    pair.reflectance[nm] = (1.0 - part) * solved.reflectance[band] + part * solved.reflectance[band + 1];
  }
  return pair;
}

bool isTableOfColours(const std::filesystem::path& file) {
  if (spectral::lowerCase(spectral::utf8(file.extension())) != ".csv" || !std::filesystem::exists(file)) {
    return false;
  }
  const std::string text = spectral::readTextFile(file);
  const std::vector<Line> lines = linesOf(text);
  return !lines.empty() && numbersOf(lines[0], spectral::utf8(file));
}

std::vector<Pair> readPairs(const std::string& nameOrFile, const spectral::DataLibrary& library,
                            const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / spectral::pathOf(nameOrFile);
  std::vector<Pair> pairs;
  if (spectral::looksLikeSpectralFile(nameOrFile) && isTableOfColours(path)) {
    const std::string text = spectral::readTextFile(path);
    const std::vector<Line> lines = linesOf(text);
    pairs = pairsOfColours(lines, *numbersOf(lines[0], spectral::utf8(path)), spectral::utf8(path), library,
                           path.parent_path());
  } else {
    for (const spectral::Spectrum& sample : library.reflectances(nameOrFile, folder).samples) {
      pairs.push_back({sample.name(), sample.onDomain()});
    }
  }
  checkCount(pairs.size(), nameOrFile);
  return pairs;
}

}  // namespace metamer::sip
