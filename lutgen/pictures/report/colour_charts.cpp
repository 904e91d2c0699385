// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "metamer/sip/spectral_locus.h"
#include "metamer/spectral/colorimetry.h"
#include "metamer/spectral/formatted.h"
#include "report/charts.h"
#include "report/drawing.h"

namespace metamer::lutgen {
namespace {

using spectral::formatted;

constexpr int kWidth = 400;

// The field, CIE 1976 u'v'.
constexpr int kFieldHeight = 400;
constexpr double kFieldLeft = 26;
constexpr double kFieldBottom = 376;
constexpr double kPerUnit = 590;
constexpr double kFieldStep = 0.035;

Eigen::Vector2d placeOf(const Eigen::Vector2d& uv) {
  return {kFieldLeft + uv.x() * kPerUnit, kFieldBottom - uv.y() * kPerUnit};
}

Eigen::Vector2d uvOf(const Eigen::Vector2d& xy) {
  return spectral::chromaticityUv(spectral::xyzFromChromaticity(xy));
}

// Differences over hue and exposure.
constexpr int kHueCells = 36;
constexpr double kMapLeft = 44;
constexpr double kMapRight = 392;
constexpr double kMapTop = 10;
constexpr double kCellHeight = 6;
constexpr double kMapBottom = kMapTop + kHueCells * kCellHeight;
constexpr int kMapHeight = 304;
/// A grey, and as far from it as its luminance lets it go on a screen, for the hues' own colours.
constexpr double kHueReach = 0.09;
/// Upper ends of the steps, CIEDE2000, and the steps' colours: viridis (van der Walt and Smith), seven of it.
constexpr std::array<double, 6> kSteps = {0.03, 0.1, 0.3, 1, 3, 10};
constexpr std::array<const char*, 7> kStepColours = {"#440154", "#443983", "#31688e", "#21918c",
                                                     "#35b779", "#90d743", "#fde725"};

std::size_t stepOf(double difference) {
  return static_cast<std::size_t>(std::upper_bound(kSteps.begin(), kSteps.end(), difference) - kSteps.begin());
}

/// The largest difference in each cell; negative where nothing fell.
struct HueExposureGrid {
  int lowest = 0;
  int stops = 1;
  std::vector<double> values;
  double& at(int stop, int hue) { return values[static_cast<std::size_t>(hue) * stops + stop]; }
};

HueExposureGrid gridOf(const sip::Comparison& comparison, const spectral::RgbSpace& space) {
  HueExposureGrid grid;
  double lowest = 0;
  double highest = 0;
  for (const sip::ComparedColour& colour : comparison.colours) {
    lowest = std::min(lowest, colour.stop);
    highest = std::max(highest, colour.stop);
  }
  grid.lowest = static_cast<int>(std::floor(lowest));
  grid.stops = static_cast<int>(std::floor(highest)) - grid.lowest + 1;
  grid.values.assign(static_cast<std::size_t>(grid.stops) * kHueCells, -1.0);
  const Eigen::Matrix3d xyzFromRgb = space.xyzFromRgb();
  const Eigen::Vector2d white = spectral::chromaticity(space.whiteXyz());
  for (const sip::ComparedColour& colour : comparison.colours) {
    const Eigen::Vector2d away = spectral::chromaticity(xyzFromRgb * colour.rgb) - white;
    const double turn = std::atan2(away.y(), away.x()) / (2.0 * std::numbers::pi);
    const int hue = std::min(kHueCells - 1, static_cast<int>(std::floor((turn < 0 ? turn + 1 : turn) * kHueCells)));
    double& cell = grid.at(static_cast<int>(std::floor(colour.stop)) - grid.lowest, hue);
    cell = std::max(cell, colour.deltaE);
  }
  return grid;
}

/// Rows of cells, runs of one step as one rectangle.
void drawCells(Drawing& drawing, HueExposureGrid& grid) {
  const double cell = (kMapRight - kMapLeft) / grid.stops;
  for (int hue = 0; hue < kHueCells; ++hue) {
    for (int start = 0; start < grid.stops;) {
      const double value = grid.at(start, hue);
      int end = start + 1;
      while (end < grid.stops && (grid.at(end, hue) < 0) == (value < 0) && stepOf(grid.at(end, hue)) == stepOf(value)) {
        ++end;
      }
      if (value >= 0) {
        drawing.rectangle(kMapLeft + start * cell, kMapBottom - (hue + 1) * kCellHeight, (end - start) * cell + 0.2,
                          kCellHeight + 0.2, kStepColours[stepOf(value)]);
      }
      start = end;
    }
  }
}

void drawStepLegend(Drawing& drawing) {
  const double width = (kMapRight - kMapLeft) / kStepColours.size();
  for (std::size_t k = 0; k < kStepColours.size(); ++k) {
    drawing.rectangle(kMapLeft + static_cast<double>(k) * width, kMapBottom + 36, width, 9, kStepColours[k]);
    if (k > 0) {
      drawing.text(kMapLeft + static_cast<double>(k) * width, kMapBottom + 58, formatted("%g", kSteps[k - 1]),
                   "middle");
    }
  }
  drawing.text(kMapLeft, kMapBottom + 58, "0", "middle");
  drawing.text(kMapRight, kMapBottom + 72, "CIEDE2000", "end");
}

}  // namespace

Chart fieldChart(const sip::TransformSpec& spec, const sip::SpectralTransform& transform, const Screen& screen) {
  Drawing drawing(kWidth, kFieldHeight, "Chromaticities, CIE 1976 u prime v prime, each with a line to where it moves");
  const sip::SpectralLocus locus(spec.standardObserver);
  std::vector<Eigen::Vector2d> outline;
  for (const Eigen::Vector2d& corner : locus.corners()) {
    outline.push_back(placeOf(uvOf(corner)));
  }
  drawing.path(outline, "outline", true);
  std::vector<Eigen::Vector2d> gamut;
  for (const Eigen::Vector2d& primary : spec.space.primaries) {
    gamut.push_back(placeOf(uvOf(primary)));
  }
  drawing.path(gamut, "gamut", true);
  drawing.line({kFieldLeft, kFieldBottom}, {kWidth - 8, kFieldBottom}, "axis");
  drawing.line({kFieldLeft, kFieldBottom}, {kFieldLeft, 8}, "axis");
  for (int tick = 1; tick <= 6; ++tick) {
    const std::string words = formatted("0.%d", tick);
    drawing.text(placeOf({0.1 * tick, 0}).x(), kFieldBottom + 14, tick == 6 ? "u' 0.6" : words, "middle");
    drawing.text(kFieldLeft - 4, placeOf({0, 0.1 * tick}).y() + 4, tick == 6 ? "v'" : words, "end");
  }
  const Eigen::Matrix3d rgbFromXyz = spec.space.rgbFromXyz();
  const Eigen::Matrix3d xyzFromRgb = spec.space.xyzFromRgb();
  const Eigen::Matrix3d plain = transform.plainAdaptation();
  double largest = 0;
  for (double u = kFieldStep / 2; u < 0.63; u += kFieldStep) {
    for (double v = kFieldStep / 2; v < 0.6; v += kFieldStep) {
      const double scale = 6 * u - 16 * v + 12;  // CIE 15: from u', v' to x, y
      const Eigen::Vector2d xy(9 * u / scale, 4 * v / scale);
      const Eigen::Vector3d rgb = rgbFromXyz * spectral::xyzFromChromaticity(xy, 0.18);
      if (rgb.minCoeff() < 0 || !locus.contains(xy)) {
        continue;
      }
      const Eigen::Vector2d from(u, v);
      const Eigen::Vector2d to = spectral::chromaticityUv(xyzFromRgb * transform.apply(rgb));
      largest = std::max(largest, (to - from).norm());
      drawing.line(placeOf(from), placeOf(spectral::chromaticityUv(xyzFromRgb * plain * rgb)), "plain");
      drawing.line(placeOf(from), placeOf(to), "move");
      drawing.dot(placeOf(from), 2.4, screen.hex(rgb * (0.8 / rgb.maxCoeff())));
    }
  }
  return {drawing.svg(),
          formatted("Each dot is a colour as shot; its solid line ends where this transform takes it, its dotted one "
                    "where plain adaptation would. The farthest goes %.3f in u'v'. Grey: all colours there are; "
                    "dashed: what %s holds.",
                    largest, spec.space.name.c_str())};
}

Chart errorChart(const sip::Comparison& comparison, const spectral::RgbSpace& space, const Screen& screen,
                 const std::string& label) {
  Drawing drawing(
      kWidth, kMapHeight,
      formatted("%s: largest difference over hue and exposure; 99 of 100 colours within %.4f, all within %.4f",
                label.c_str(), comparison.p99, comparison.max));
  HueExposureGrid grid = gridOf(comparison, space);
  drawCells(drawing, grid);
  const Eigen::Vector2d white = spectral::chromaticity(space.whiteXyz());
  for (int hue = 0; hue < kHueCells; ++hue) {
    const double angle = (hue + 0.5) / kHueCells * 2.0 * std::numbers::pi;
    const Eigen::Vector2d xy = white + kHueReach * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    const Eigen::Vector3d rgb = (space.rgbFromXyz() * spectral::xyzFromChromaticity(xy)).cwiseMax(0.0);
    drawing.rectangle(kMapLeft - 10, kMapBottom - (hue + 1) * kCellHeight, 7, kCellHeight + 0.2,
                      screen.hex(rgb * (0.8 / rgb.maxCoeff())));
  }
  drawing.text(4, kMapTop + 8, "hue");
  drawing.text(kMapLeft, kMapBottom + 14, formatted("%+d stops", grid.lowest));
  const double middle = kMapLeft + (0.5 - grid.lowest) * (kMapRight - kMapLeft) / grid.stops;
  drawing.text(middle, kMapBottom + 14, "18 % grey", "middle");
  drawing.text(kMapRight, kMapBottom + 14, formatted("%+d stops", grid.lowest + grid.stops - 1), "end");
  drawStepLegend(drawing);
  return {drawing.svg(), label + ": the largest difference in each cell, on a logarithmic scale; dark is good"};
}

Chart surfaceChart(const SurfaceGroup& group, const Screen& screen) {
  constexpr int kColumns = 6;
  constexpr double kCell = kWidth / static_cast<double>(kColumns);
  constexpr double kPatch = kCell - 8;
  constexpr double kAbove = 10;
  constexpr double kBelow = 36;
  constexpr double kRow = kAbove + kBelow + 20;
  const int rows = (static_cast<int>(group.surfaces.size()) + kColumns - 1) / kColumns;
  const GroupMeans means = meansOf(group);
  Drawing drawing(kWidth, static_cast<int>(rows * kRow),
                  formatted("%s, %zu surfaces: this transform is %.2f from the truth on average, plain adaptation %.2f",
                            group.title.c_str(), group.surfaces.size(), means.engine, means.plain));
  for (std::size_t k = 0; k < group.surfaces.size(); ++k) {
    const KnownSurface& surface = group.surfaces[k];
    const double left = static_cast<double>(k % kColumns) * kCell + 4;
    const double top = std::floor(static_cast<double>(k / kColumns)) * kRow;
    drawing.rectangle(left, top, kPatch, kAbove, screen.hex(surface.asShot));
    drawing.rectangle(left, top + kAbove, kPatch / 3 + 0.4, kBelow, screen.hex(surface.engine));
    drawing.rectangle(left + kPatch / 3, top + kAbove, kPatch / 3 + 0.4, kBelow, screen.hex(surface.truth));
    drawing.rectangle(left + 2 * kPatch / 3, top + kAbove, kPatch / 3, kBelow, screen.hex(surface.plain));
    drawing.text(left, top + kAbove + kBelow + 12, formatted("%.1f", surface.engineError));
    drawing.text(left + kPatch, top + kAbove + kBelow + 12, formatted("%.1f", surface.plainError), "end");
  }
  const auto worst =
      std::max_element(group.surfaces.begin(), group.surfaces.end(),
                       [](const KnownSurface& a, const KnownSurface& b) { return a.engineError < b.engineError; });
  return {drawing.svg(),
          formatted("This transform is %.2f from the truth on average (at most %.2f, %s), plain adaptation %.2f.",
                    means.engine, worst->engineError, worst->name.c_str(), means.plain)};
}

}  // namespace metamer::lutgen
