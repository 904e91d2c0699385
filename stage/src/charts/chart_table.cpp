// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/chart_table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"

namespace metamer::stage {
namespace {

using spectral::InputError;

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<const char*, 3> kChannels = {"R", "G", "B"};

/// Cells of a line; a quoted one may hold the delimiter, and a doubled quote for one.
std::vector<std::string> cellsOf(std::string_view line, char delimiter) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      cells.back() += c;
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == delimiter && !quoted) {
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

double numberOf(const std::string& cell, const std::string& where, const std::string& field) {
  const std::string text = spectral::lowerCase(cell);
  if (text.empty() || text == "nan" || text == "inf" || text == "+inf" || text == "-inf") {
    return kMissing;
  }
  double value = 0;
  const char* begin = text.data() + (text.front() == '+' ? 1 : 0);
  const char* end = text.data() + text.size();
  const auto parsed = std::from_chars(begin, end, value);
  if (parsed.ec != std::errc() || parsed.ptr != end) {
    throw InputError(where, field, cell, "must be a number, or empty where the patch was not measured");
  }
  return value;
}

/// Where patch, R, G and B stand in the header.
struct Columns {
  char delimiter = ',';
  std::size_t patch = 0;
  std::array<std::size_t, 3> rgb{};
};

Columns readHeader(std::string_view line, const std::string& where) {
  Columns columns;
  for (const char delimiter : {',', ';', '\t'}) {
    if (line.find(delimiter) != std::string_view::npos) {
      columns.delimiter = delimiter;
      break;
    }
  }
  const std::vector<std::string> cells = cellsOf(line, columns.delimiter);
  const auto find = [&](const std::string& name) {
    const auto found =
        std::find_if(cells.begin(), cells.end(), [&](const auto& cell) { return spectral::lowerCase(cell) == name; });
    if (found == cells.end()) {
      throw InputError(where, "header", std::string(line), "must be patch,R,G,B; the column " + name + " is missing");
    }
    return static_cast<std::size_t>(found - cells.begin());
  };
  columns.patch = find("patch");
  columns.rgb = {find("r"), find("g"), find("b")};
  return columns;
}

/// The value at which a chart's channel is clipped, as its own numbers tell; infinite where they do not.
double clippingOf(const Eigen::Matrix3Xd& rgb) {
  double largest = 0;
  for (const double value : rgb.reshaped()) {
    largest = std::isfinite(value) ? std::max(largest, value) : largest;
  }
  if (!(largest > 0)) {
    return std::numeric_limits<double>::infinity();
  }
  Eigen::Index first = -1;
  for (Eigen::Index patch = 0; patch < rgb.cols(); ++patch) {
    if ((rgb.col(patch).array() == largest).any()) {
      if (first >= 0 && rgb.col(patch) != rgb.col(first)) {
        return largest;
      }
      first = first < 0 ? patch : first;
    }
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

ChartTable parseChart(const std::string& text, const std::string& where) {
  std::string_view rest = text;
  if (rest.substr(0, 3) == "\xEF\xBB\xBF") {
    rest.remove_prefix(3);
  }
  ChartTable chart;
  chart.where = where;
  std::optional<Columns> columns;
  std::unordered_map<std::string, std::size_t> lines;
  std::vector<double> values;
  std::size_t number = 0;
  while (!rest.empty()) {
    ++number;
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = spectral::trimmed(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (line.empty() || line.front() == '#') {
      continue;
    }
    const std::string at = where + ":" + std::to_string(number);
    if (line.find('\0') != std::string_view::npos) {
      throw InputError(at, "text", "", "is not a text file");
    }
    if (!columns) {
      columns = readHeader(line, at);
      continue;
    }
    const std::vector<std::string> cells = cellsOf(line, columns->delimiter);
    const auto cell = [&](std::size_t column) { return column < cells.size() ? cells[column] : std::string(); };
    const std::string name = cell(columns->patch);
    if (name.empty()) {
      throw InputError(at, "patch", "", "has no name; give each patch one");
    }
    const auto [earlier, isNew] = lines.emplace(name, number);
    if (!isNew) {
      throw InputError(at, "patch", name, "is given twice, in line " + std::to_string(earlier->second) + " as well");
    }
    if (chart.names.size() == kMostPatches) {
      throw InputError(at, "patches", "", "are more than " + std::to_string(kMostPatches));
    }
    chart.names.push_back(name);
    for (std::size_t k = 0; k < 3; ++k) {
      values.push_back(numberOf(cell(columns->rgb[k]), at, kChannels[k]));
    }
  }
  if (chart.names.empty()) {
    throw InputError(where, "patches", "", "are missing; a chart is the header patch,R,G,B and a line a patch");
  }
  chart.rgb = Eigen::Map<const Eigen::Matrix3Xd>(values.data(), 3, static_cast<Eigen::Index>(chart.names.size()));
  return chart;
}

AlignedCharts alignCharts(const std::vector<ChartTable>& charts, std::optional<double> saturation,
                          const std::vector<std::string>& unwanted) {
  if (charts.empty()) {
    throw InputError("", "charts", "0", "are none; give at least one");
  }
  for (const ChartTable& chart : charts) {
    spectral::requireAsMany("names of a chart", static_cast<std::int64_t>(chart.names.size()), "its patches",
                            chart.rgb.cols());
  }
  AlignedCharts aligned;
  std::vector<std::unordered_map<std::string, Eigen::Index>> places(charts.size());
  std::vector<double> clipping;
  for (std::size_t c = 0; c < charts.size(); ++c) {
    for (std::size_t i = 0; i < charts[c].names.size(); ++i) {
      places[c].emplace(charts[c].names[i], static_cast<Eigen::Index>(i));
    }
    clipping.push_back(saturation.value_or(clippingOf(charts[c].rgb)));
  }
  const auto reasonAgainst = [&](const std::string& name) -> std::string {
    if (std::find(unwanted.begin(), unwanted.end(), name) != unwanted.end()) {
      return "left out as asked";
    }
    for (std::size_t c = 0; c < charts.size(); ++c) {
      const auto place = places[c].find(name);
      if (place == places[c].end()) {
        return "missing in " + charts[c].where;
      }
      const Eigen::Vector3d rgb = charts[c].rgb.col(place->second);
      if (!rgb.allFinite()) {
        return "a value is missing in " + charts[c].where;
      }
      if (rgb.maxCoeff() >= clipping[c]) {
        return "saturated in " + charts[c].where;
      }
    }
    return {};
  };
  // The last chart's patches in their order, then those that it lacks, to be named among the excluded.
  std::vector<std::string> order = charts.back().names;
  std::unordered_set<std::string> known(order.begin(), order.end());
  for (const ChartTable& chart : charts) {
    for (const std::string& name : chart.names) {
      if (known.insert(name).second) {
        order.push_back(name);
      }
    }
  }
  for (const std::string& name : order) {
    const std::string reason = reasonAgainst(name);
    if (reason.empty()) {
      aligned.names.push_back(name);
    } else {
      aligned.excluded.push_back({name, reason});
    }
  }
  for (std::size_t c = 0; c < charts.size(); ++c) {
    Eigen::Matrix3Xd rgb(3, static_cast<Eigen::Index>(aligned.names.size()));
    for (std::size_t i = 0; i < aligned.names.size(); ++i) {
      rgb.col(static_cast<Eigen::Index>(i)) = charts[c].rgb.col(places[c].at(aligned.names[i]));
    }
    aligned.charts.push_back(std::move(rgb));
  }
  return aligned;
}

}  // namespace metamer::stage
