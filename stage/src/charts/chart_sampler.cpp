// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/chart_sampler.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/colorimetry.h"
#include "metamer/spectral/input_error.h"

namespace metamer::stage {
namespace {

using spectral::InputError;

/// A chart lies turned where another turn fits its reflectances this much better.
constexpr double kClearlyMoreAlike = 0.2;
/// Patches below this are too few to tell a turn.
constexpr Eigen::Index kFewestPatchesOfATurn = 12;

/// Mean of a patch; not a number where part of it lies outside or is not finite.
Eigen::Vector3d meanOf(const PictureView& picture, const ChartGrid& grid, int column, int row,
                       std::optional<double> saturation) {
  Eigen::Vector3d missing = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  Eigen::AlignedBox2d bounds;
  for (const Eigen::Vector2d& corner : grid.sampledSquare(column, row)) {
    bounds.extend(corner);
  }
  if (!(bounds.min().minCoeff() >= 0) || bounds.max().x() > picture.width || bounds.max().y() > picture.height) {
    return missing;
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0;
  bool isClipped = false;
  for (int y = static_cast<int>(bounds.min().y()); y < bounds.max().y(); ++y) {
    for (int x = static_cast<int>(bounds.min().x()); x < bounds.max().x(); ++x) {
      if (grid.isInSampledSquare({x + 0.5, y + 0.5}, column, row)) {
        const Eigen::Vector3d rgb = picture.at(x, y);
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

Eigen::Matrix3Xd sampledPatches(const PictureView& picture, const ChartGrid& grid, std::optional<double> saturation) {
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
  return likeness(known.row(strongest).transpose(), expected.row(strongest).transpose());
}

std::vector<Eigen::Vector2d> turned(std::vector<Eigen::Vector2d> corners, int quarters) {
  std::rotate(corners.begin(), corners.begin() + quarters, corners.end());
  return corners;
}

void check(const PictureView& picture) {
  spectral::requireWithin("picture's width", picture.width, 1, std::numeric_limits<int>::max());
  spectral::requireWithin("picture's height", picture.height, 1, std::numeric_limits<int>::max());
  spectral::requireWithin("picture's channels", picture.channels, 1, std::numeric_limits<int>::max());
  spectral::requireAsMany("picture's values", static_cast<std::int64_t>(picture.values.size()),
                          "width x height x channels", std::int64_t{picture.width} * picture.height * picture.channels);
  for (const int channel : picture.colours) {
    spectral::requireWithin("picture's colours", channel, 0, picture.channels - 1);
  }
}

}  // namespace

ChartSampler::ChartSampler(const StageLayout& layout, const spectral::DataLibrary& library,
                           const std::filesystem::path& folder, std::optional<double> saturation)
    : m_layout(layout), m_names(layout.names), m_saturation(saturation) {
  spectral::requireWithin("charts.columns", layout.columns, 1, ChartGrid::kMostAlong);
  spectral::requireWithin("charts.rows", layout.rows, 1, ChartGrid::kMostAlong);
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

ChartSampler::Sampled ChartSampler::sample(const PictureView& picture,
                                           const std::vector<Eigen::Vector2d>& corners) const {
  check(picture);
  const ChartGrid asGiven(corners, m_layout.columns, m_layout.rows);
  Sampled result{sampledPatches(picture, asGiven, m_saturation), asGiven, 0};
  if (m_expected.cols() >= kFewestPatchesOfATurn) {
    double best = likenessOf(result.rgb, m_expected) + kClearlyMoreAlike;
    for (int turn = 1; turn < 4; ++turn) {
      const ChartGrid other(turned(corners, turn), m_layout.columns, m_layout.rows);
      const Eigen::Matrix3Xd rgb = sampledPatches(picture, other, m_saturation);
      if (likenessOf(rgb, m_expected) > best) {
        best = likenessOf(rgb, m_expected);
        result = {rgb, other, turn};
      }
    }
  }
  return result;
}

Eigen::Vector3d meanOfBox(const PictureView& picture, const std::array<int, 4>& box, const std::string& where) {
  check(picture);
  const auto [left, top, right, bottom] = box;
  if (left < 0 || top < 0 || left >= right || top >= bottom || right > picture.width || bottom > picture.height) {
    throw InputError(where, "box",
                     std::to_string(left) + ", " + std::to_string(top) + ", " + std::to_string(right) + ", " +
                         std::to_string(bottom),
                     "must lie within the picture of " + std::to_string(picture.width) + " x " +
                         std::to_string(picture.height) + ", left before right and top before bottom");
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) {
      sum += picture.at(x, y);
    }
  }
  Eigen::Vector3d mean = sum / (static_cast<double>(right - left) * (bottom - top));
  if (!mean.allFinite()) {
    throw InputError(where, "box", "", "holds pixels that are not finite");
  }
  return mean;
}

}  // namespace metamer::stage
