// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "files/sampled_rows.h"
#include "metamer/spectral/fluorescence.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/spectral_picture.h"
#include "metamer/spectral/text.h"
#include "tables/table_text.h"
#include "tables/wavelength_cell.h"

namespace metamer::spectral {
namespace {

constexpr auto kReflected = SpectralQuantity::Reflectance;
constexpr const char* kTableRemedy =
    "give a header row of excitations and rows of an emission and its factors, or the compact form (see the manual)";
/// Bands an axis: 1 nm from the ultraviolet to the near infrared.
constexpr std::size_t kMostBands = 2000;

double wavelengthOf(std::string_view cell, const TableText& table, const TableLine& line) {
  const auto wavelength = wavelengthCell(unquoted(cell), table.separator);
  if (!wavelength || wavelength->isLabelled || (wavelength->nmPerUnit > 0 && wavelength->nmPerUnit != 1.0)) {
    throw InputError(table.at(line), "wavelength", std::string(cell), "must be a number of nm");
  }
  return wavelength->value;
}

double valueOf(std::string_view cell, const TableText& table, const TableLine& line) {
  const auto number = cellNumber(cell, table.separator);
  return number ? *number : requiredNumber(unquoted(cell), table.at(line), "value");
}

/// The cells of a line, without empty ones behind the last.
std::vector<std::string_view> filledCells(const TableLine& line, const TableText& table) {
  std::vector<std::string_view> cells = cellsOf(line, table);
  while (!cells.empty() && trimmed(cells.back()).empty()) {
    cells.pop_back();
  }
  return cells;
}

void requireCells(const std::vector<std::string_view>& cells, std::size_t count, const TableText& table,
                  const TableLine& line) {
  if (cells.size() != count) {
    throw InputError(table.at(line), "cells", std::to_string(cells.size()),
                     "must be " + std::to_string(count) + ", as in the header; fill gaps in, with 0 where nothing is");
  }
}

CompactFluorescence readCompact(const std::vector<const TableLine*>& lines, const TableText& table) {
  const auto first = filledCells(*lines[0], table);
  requireCells(first, 2, table, *lines[0]);
  const double quantumYield = valueOf(first[1], table, *lines[0]);
  const auto header = filledCells(*lines[1], table);
  constexpr const char* kColumns[] = {"reflectance", "excitation", "emission"};
  requireCells(header, 4, table, *lines[1]);
  for (std::size_t c = 0; c < 3; ++c) {
    if (lowerCase(trimmed(unquoted(header[c + 1]))) != kColumns[c]) {
      throw InputError(table.at(*lines[1]), "column " + std::to_string(c + 2), std::string(header[c + 1]),
                       "must be " + std::string(kColumns[c]) + ": wavelength_nm,reflectance,excitation,emission");
    }
  }
  std::vector<double> nm;
  std::vector<double> columns[3];
  for (std::size_t k = 2; k < lines.size(); ++k) {
    const auto cells = filledCells(*lines[k], table);
    requireCells(cells, 4, table, *lines[k]);
    nm.push_back(wavelengthOf(cells[0], table, *lines[k]));
    for (std::size_t c = 0; c < 3; ++c) {
      columns[c].push_back(valueOf(cells[c + 1], table, *lines[k]));
    }
  }
  const std::string& name = table.where;
  return {name,
          {name, kReflected, nm, columns[0]},
          {name, SpectralQuantity::Sensitivity, nm, columns[1]},
          {name, SpectralQuantity::Sensitivity, nm, columns[2]},
          quantumYield};
}

Reradiation readMatrix(const std::vector<const TableLine*>& lines, const TableText& table) {
  std::vector<double> excitation;
  const auto header = filledCells(*lines[0], table);
  for (std::size_t c = 1; c < header.size(); ++c) {
    excitation.push_back(wavelengthOf(header[c], table, *lines[0]));
  }
  if (excitation.size() > kMostBands || lines.size() > kMostBands) {
    throw InputError(table.where, "bands", std::to_string(std::max(excitation.size(), lines.size())),
                     "are more than 2000; resample the matrix");
  }
  std::vector<double> emission;
  Eigen::MatrixXd factors(lines.size() - 1, static_cast<Eigen::Index>(excitation.size()));
  for (std::size_t k = 1; k < lines.size(); ++k) {
    const auto cells = filledCells(*lines[k], table);
    requireCells(cells, header.size(), table, *lines[k]);
    emission.push_back(wavelengthOf(cells[0], table, *lines[k]));
    for (std::size_t c = 1; c < cells.size(); ++c) {
      factors(static_cast<Eigen::Index>(k) - 1, static_cast<Eigen::Index>(c) - 1) = valueOf(cells[c], table, *lines[k]);
    }
  }
  return {table.where, std::move(excitation), std::move(emission), std::move(factors)};
}

/// What the six whole numbers of a BFC file say.
struct BfcAxes {
  std::vector<double> excitation;
  std::vector<double> emission;
};

std::optional<BfcAxes> bfcAxes(const std::vector<std::string_view>& cells) {
  if (cells.size() != 6) {
    return std::nullopt;
  }
  double numbers[6] = {};
  for (std::size_t k = 0; k < 6; ++k) {
    const auto number = parseNumber(cells[k]);
    if (!number || *number <= 0 || *number > 1e5 || std::floor(*number) != *number) {
      return std::nullopt;
    }
    numbers[k] = *number;
  }
  const auto [firstOut, lastOut, stepOut, countIn, firstIn, stepIn] = numbers;
  const double rows = (lastOut - firstOut) / stepOut + 1;
  if (lastOut < firstOut || rows > kMostBands || countIn > kMostBands) {
    return std::nullopt;
  }
  BfcAxes axes;
  for (int k = 0; k < static_cast<int>(rows); ++k) {
    axes.emission.push_back(firstOut + k * stepOut);
  }
  for (int k = 0; k < static_cast<int>(countIn); ++k) {
    axes.excitation.push_back(firstIn + k * stepIn);
  }
  return axes;
}

std::vector<std::string_view> wordsOf(std::string_view line) {
  std::vector<std::string_view> words;
  while (!(line = trimmed(line)).empty()) {
    const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
    words.push_back(line.substr(0, end));
    line = line.substr(end);
  }
  return words;
}

Reradiation readBispectralPicture(const std::string& file, const std::string& place,
                                  const PictureChannelReader& pictures) {
  std::map<std::pair<double, double>, double> values;
  std::set<double> excitation;
  std::set<double> emission;
  const auto pairOf = [](const std::string& channel) -> std::optional<std::pair<double, double>> {
    if (const auto nm = channelWavelengthNm(channel, kReflected)) {
      return std::pair(*nm, *nm);
    }
    return channelPairNm(channel);
  };
  // Names carry wavelengths to six digits, and units of them are converted.
  const auto rounded = [](double nm) { return std::round(nm * 1e4) * 1e-4; };
  bool isBispectral = false;
  for (const ChannelValue& channel : readPictureChannels(
           file, place, [&](const std::string& name) { return pairOf(name).has_value(); }, pictures)) {
    const auto [from, to] = *pairOf(channel.name);
    isBispectral = isBispectral || from != to;
    values[{rounded(from), rounded(to)}] = channel.value;
    excitation.insert(rounded(from));
    emission.insert(rounded(to));
  }
  if (!isBispectral) {
    throw InputError(file, "channels", "",
                     "are not bispectral: none is named as 'T.380,000000nm.400,000000nm' (JCGT 2021); give such a "
                     "picture, or a table");
  }
  const std::vector<double> in(excitation.begin(), excitation.end());
  const std::vector<double> out(emission.begin(), emission.end());
  Eigen::MatrixXd factors =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(out.size()), static_cast<Eigen::Index>(in.size()));
  for (std::size_t i = 0; i < in.size(); ++i) {
    for (std::size_t o = 0; o < out.size(); ++o) {
      const auto found = values.find({in[i], out[o]});
      if (found != values.end()) {
        factors(static_cast<Eigen::Index>(o), static_cast<Eigen::Index>(i)) = found->second;
      } else if (out[o] >= in[i]) {
        throw InputError(
            file, "channel", numberText(in[i]) + " to " + numberText(out[o]) + " nm",
            "is missing where others have both wavelengths; a matrix has no gaps, write 0 where nothing is");
      }
    }
  }
  return {file, in, out, std::move(factors)};
}

}  // namespace

std::optional<std::pair<double, double>> channelPairNm(const std::string& channel) {
  for (std::size_t dot = channel.find('.'); dot != std::string::npos; dot = channel.find('.', dot + 1)) {
    const auto from = channelWavelengthNm(channel.substr(0, dot), kReflected);
    const auto to = channelWavelengthNm("T." + channel.substr(dot + 1), kReflected);
    if (from && to) {
      return std::pair(*from, *to);
    }
  }
  return std::nullopt;
}

Fluorescence readFluorescenceTable(const std::string& text, const std::string& where) {
  const TableText table = tableText(checkedUtf8(text, where), where);
  std::vector<const TableLine*> lines;
  for (const TableLine& line : table.lines) {
    if (!line.isComment) {
      lines.push_back(&line);
    }
  }
  if (lines.size() < 3) {
    throw InputError(where, "rows", std::to_string(lines.size()), std::string("are too few; ") + kTableRemedy);
  }
  if (lowerCase(trimmed(unquoted(cellsOf(*lines[0], table)[0]))) == "quantum_yield") {
    return readCompact(lines, table);
  }
  return readMatrix(lines, table);
}

Reradiation readBfc(const std::string& text, const std::string& where) {
  std::string_view rest = checkedUtf8(text, where);
  std::optional<BfcAxes> axes;
  Eigen::MatrixXd factors;
  Eigen::Index row = 0;
  bool isHeading = false;
  bool isEnd = false;
  for (int number = 1; !rest.empty() && !isEnd; ++number) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::vector<std::string_view> words = wordsOf(rest.substr(0, end));
    rest = rest.substr(std::min(end + 1, rest.size()));
    const std::string at = where + ":" + std::to_string(number);
    if (!axes) {
      axes = bfcAxes(words);
      if (axes) {
        factors.resize(static_cast<Eigen::Index>(axes->emission.size()),
                       static_cast<Eigen::Index>(axes->excitation.size()));
        isHeading = true;
      }
      continue;
    }
    if (words.empty() || std::exchange(isHeading, false)) {
      continue;  // the excitations again, or one of the empty lines that instruments leave
    }
    if (words[0].substr(0, 3) == "EOD") {
      isEnd = true;
      continue;
    }
    const double emission = requiredNumber(words[0], at, "emission");
    if (row == factors.rows() || emission != axes->emission[static_cast<std::size_t>(row)]) {
      throw InputError(at, "emission", numberText(emission), "is not the next one that the file's six numbers name");
    }
    if (words.size() != axes->excitation.size() + 1) {
      throw InputError(at, "values", std::to_string(words.size() - 1),
                       "must be " + std::to_string(axes->excitation.size()) + ", one an excitation");
    }
    for (std::size_t c = 1; c < words.size(); ++c) {
      factors(row, static_cast<Eigen::Index>(c) - 1) = requiredNumber(words[c], at, "value");
    }
    ++row;
  }
  if (!axes) {
    throw InputError(where, "header", "",
                     "has no line of six whole numbers (emission from, to, step; count, first and step of excitation); "
                     "give a BFC-450 matrix file");
  }
  if (row < factors.rows()) {
    throw InputError(where, "rows", std::to_string(row),
                     "must be " + std::to_string(factors.rows()) + ", one an emission; the file is cut short");
  }
  return {where, std::move(axes->excitation), std::move(axes->emission), std::move(factors)};
}

Fluorescence readFluorescence(const std::filesystem::path& file, const PictureChannelReader& pictures) {
  const auto [where, place] = spectralFileName(utf8(file));
  const std::string extension = lowerCase(utf8(pathOf(where).extension()));
  if (extension == ".exr") {
    return readBispectralPicture(where, place, pictures);
  }
  if (extension == ".bfc") {
    return readBfc(readTextFile(pathOf(where)), where);
  }
  if (extension != ".csv" && extension != ".txt" && extension != ".tsv") {
    throw InputError(where, "extension", extension, "must be .csv, .txt, .tsv, .bfc or .exr");
  }
  return readFluorescenceTable(readTextFile(pathOf(where)), where);
}

}  // namespace metamer::spectral
