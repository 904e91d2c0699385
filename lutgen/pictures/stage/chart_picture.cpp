// SPDX-License-Identifier: Apache-2.0
#include "stage/chart_picture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include "metamer/spectral/colorimetry.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/text.h"
#include "metamer/stage/chart_grid.h"
#include "picture.h"
#include "stage/check_picture.h"

namespace metamer::lutgen {
namespace {

using spectral::InputError;

/// A chart lies turned where another turn fits its reflectances this much better.
constexpr double kClearlyMoreAlike = 0.2;
/// Patches below this are too few to tell a turn.
constexpr Eigen::Index kFewestPatchesOfATurn = 12;

bool isTable(const std::filesystem::path& file) {
  const std::string extension = spectral::lowerCase(file.extension().string());
  return extension == ".csv" || extension == ".txt" || extension == ".tsv";
}

Eigen::Vector3d pixelOf(const Picture& picture, int x, int y) {
  std::vector<float> channels(static_cast<std::size_t>(picture.pixels().nchannels()));
  picture.pixels().getpixel(x, y, channels.data(), picture.pixels().nchannels());
  Eigen::Vector3d rgb;
  for (std::size_t k = 0; k < 3; ++k) {
    rgb[static_cast<Eigen::Index>(k)] = channels[static_cast<std::size_t>(picture.colours()[k])];
  }
  return rgb;
}

/// Mean of a patch; not a number where part of it lies outside or is not finite.
Eigen::Vector3d meanOf(const Picture& picture, const stage::ChartGrid& grid, int column, int row,
                       std::optional<double> saturation) {
  const auto& spec = picture.pixels().spec();
  Eigen::Vector3d missing = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  Eigen::AlignedBox2d bounds;
  for (const Eigen::Vector2d& corner : grid.sampledSquare(column, row)) {
    bounds.extend(corner);
  }
  if (!(bounds.min().minCoeff() >= 0) || bounds.max().x() > spec.width || bounds.max().y() > spec.height) {
    return missing;
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0;
  bool isClipped = false;
  for (int y = static_cast<int>(bounds.min().y()); y < bounds.max().y(); ++y) {
    for (int x = static_cast<int>(bounds.min().x()); x < bounds.max().x(); ++x) {
      if (grid.isInSampledSquare({x + 0.5, y + 0.5}, column, row)) {
        const Eigen::Vector3d rgb = pixelOf(picture, spec.x + x, spec.y + y);
        isClipped = isClipped || (saturation && rgb.maxCoeff() >= *saturation);
        sum += rgb;
        ++count;
      }
    }
  }
  if (isClipped) {
    return Eigen::Vector3d::Constant(*saturation);
  }
  return count > 0 && sum.allFinite() ? Eigen::Vector3d(sum / count) : missing;
}

Eigen::Matrix3Xd sampled(const Picture& picture, const stage::ChartGrid& grid, std::optional<double> saturation) {
  Eigen::Matrix3Xd rgb(3, grid.columns() * grid.rows());
  for (int row = 0; row < grid.rows(); ++row) {
    for (int column = 0; column < grid.columns(); ++column) {
      rgb.col(row * grid.columns() + column) = meanOf(picture, grid, column, row, saturation);
    }
  }
  return rgb;
}

/// In the channel that the light is strongest in: a chart under one emitter has little else.
double likenessOf(const Eigen::Matrix3Xd& rgb, const Eigen::Matrix3Xd& expected) {
  const Eigen::Matrix3Xd known = rgb.unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; });
  Eigen::Index strongest = 0;
  known.rowwise().sum().maxCoeff(&strongest);
  return stage::likeness(known.row(strongest).transpose(), expected.row(strongest).transpose());
}

std::vector<Eigen::Vector2d> turned(std::vector<Eigen::Vector2d> corners, int quarters) {
  std::rotate(corners.begin(), corners.begin() + quarters, corners.end());
  return corners;
}

}  // namespace

ChartReader::ChartReader(const stage::StageLayout& layout, const spectral::DataLibrary& library,
                         const std::filesystem::path& folder, std::optional<double> saturation)
    : m_layout(layout), m_names(layout.names), m_saturation(saturation) {
  const auto count = static_cast<std::size_t>(layout.columns) * static_cast<std::size_t>(layout.rows);
  const spectral::ReflectanceSet set = library.reflectances(layout.reflectances, folder);
  if (m_names.empty() && set.samples.size() == count) {
    const auto eye = library.observer("CIE 1931 2");
    const auto even = library.illuminant("E");
    const Eigen::Matrix3d rgbFromXyz = library.colourSpace("ACEScg").linear.rgbFromXyz();
    m_expected.resize(3, static_cast<Eigen::Index>(count));
    for (const spectral::Spectrum& sample : set.samples) {
      m_expected.col(static_cast<Eigen::Index>(m_names.size())) = rgbFromXyz * spectral::tristimulus(sample, even, eye);
      m_names.push_back(sample.name());
    }
  }
  if (m_names.empty()) {
    for (std::size_t i = 0; i < count; ++i) {
      m_names.push_back("patch " + std::to_string(i + 1));
    }
  }
  if (m_names.size() != count) {
    throw InputError("", "charts.names", std::to_string(m_names.size()),
                     "must be as many as the chart has patches, " + std::to_string(count));
  }
}

stage::ChartTable ChartReader::read(const stage::StageChart& chart, std::vector<std::string>& notes,
                                    const std::filesystem::path& checkPicture) const {
  if (isTable(chart.file)) {
    return stage::parseChart(spectral::readTextFile(chart.file), chart.file.string());
  }
  if (chart.corners.empty()) {
    throw InputError(chart.file.string(), "corners", "",
                     "are missing; a picture needs the chart's four corners, or give a CSV (patch,R,G,B)");
  }
  return sample(chart, notes, checkPicture);
}

stage::ChartTable ChartReader::sample(const stage::StageChart& chart, std::vector<std::string>& notes,
                                      const std::filesystem::path& checkPicture) const {
  const Picture picture(chart.file);
  stage::ChartTable table{chart.file.string(), m_names, {}};
  int quarters = 0;
  stage::ChartGrid grid(chart.corners, m_layout.columns, m_layout.rows);
  table.rgb = sampled(picture, grid, m_saturation);
  if (m_expected.cols() >= kFewestPatchesOfATurn) {
    double best = likenessOf(table.rgb, m_expected) + kClearlyMoreAlike;
    for (int turn = 1; turn < 4; ++turn) {
      const stage::ChartGrid other(turned(chart.corners, turn), m_layout.columns, m_layout.rows);
      const Eigen::Matrix3Xd rgb = sampled(picture, other, m_saturation);
      if (likenessOf(rgb, m_expected) > best) {
        best = likenessOf(rgb, m_expected);
        quarters = turn;
        grid = other;
        table.rgb = rgb;
      }
    }
  }
  if (quarters != 0) {
    notes.push_back(table.where + ": the chart lies turned by " + std::to_string(90 * quarters) +
                    " degrees against its corners; its patches were read that way");
  }
  if (!checkPicture.empty()) {
    writeCheckPicture(picture, grid, checkPicture);
  }
  return table;
}

Eigen::Vector3d readPrimary(const stage::StagePrimary& primary) {
  if (primary.value) {
    return *primary.value;
  }
  const Picture picture(primary.file);
  const auto& spec = picture.pixels().spec();
  const auto [left, top, right, bottom] = primary.box;
  if (left >= right || top >= bottom || right > spec.width || bottom > spec.height) {
    throw InputError(primary.file.string(), "box",
                     std::to_string(left) + ", " + std::to_string(top) + ", " + std::to_string(right) + ", " +
                         std::to_string(bottom),
                     "must lie within the picture of " + std::to_string(spec.width) + " x " +
                         std::to_string(spec.height) + ", left before right and top before bottom");
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) {
      sum += pixelOf(picture, spec.x + x, spec.y + y);
    }
  }
  Eigen::Vector3d mean = sum / (static_cast<double>(right - left) * (bottom - top));
  if (!mean.allFinite()) {
    throw InputError(primary.file.string(), "box", "", "holds pixels that are not finite");
  }
  return mean;
}

}  // namespace metamer::lutgen
