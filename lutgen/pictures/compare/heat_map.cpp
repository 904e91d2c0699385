// SPDX-License-Identifier: Apache-2.0
#include "compare/heat_map.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "metamer/spectral/colorimetry.h"
#include "metamer/spectral/text.h"
#include "picture.h"

namespace metamer::lutgen {
namespace {

constexpr float kBackground = 0.15F;
constexpr float kNothing = -1.0F;  ///< no colour fell here
constexpr int kMargin = 56;
constexpr int kPanel = 460;
constexpr int kBar = 18;
constexpr double kChromaticitySpan = 0.9;  ///< of x and y from 0
/// Cells take the nearest colour's difference this far, in cells: 0.03 in xy.
constexpr int kReach = 12;
constexpr int kCells = 360;
constexpr int kHueCells = 36;

/// A grid of the largest difference in each cell, row 0 at the top.
class Grid {
 public:
  Grid(int width, int height)
      : m_width(width), m_height(height), m_values(static_cast<std::size_t>(width) * height, kNothing) {}

  int width() const { return m_width; }
  int height() const { return m_height; }
  float at(int x, int y) const { return m_values[static_cast<std::size_t>(y) * m_width + x]; }
  void add(int x, int y, double value) {
    if (x >= 0 && x < m_width && y >= 0 && y < m_height) {
      float& cell = m_values[static_cast<std::size_t>(y) * m_width + x];
      cell = std::max(cell, static_cast<float>(std::min(value, 1e6)));
    }
  }
  /// Empty cells take the value of the nearest that is not, within `reach` cells.
  Grid filled(int reach) const {
    Grid result = *this;
    for (int y = 0; y < m_height; ++y) {
      for (int x = 0; x < m_width; ++x) {
        if (at(x, y) >= 0.0F) {
          continue;
        }
        int nearest = reach * reach + 1;
        for (int v = std::max(0, y - reach); v <= std::min(m_height - 1, y + reach); ++v) {
          for (int u = std::max(0, x - reach); u <= std::min(m_width - 1, x + reach); ++u) {
            const int distance = (u - x) * (u - x) + (v - y) * (v - y);
            if (distance < nearest && at(u, v) >= 0.0F) {
              nearest = distance;
              result.m_values[static_cast<std::size_t>(y) * m_width + x] = at(u, v);
            }
          }
        }
      }
    }
    return result;
  }

 private:
  int m_width;
  int m_height;
  std::vector<float> m_values;
};

/// The sheet that panels are drawn on.
class Sheet {
 public:
  Sheet(int width, int height) : m_pixels(OIIO::ImageSpec(width, height, 3, OIIO::TypeDesc::FLOAT)) {
    OIIO::ImageBufAlgo::fill(m_pixels, {kBackground, kBackground, kBackground});
  }

  /// A grid scaled to a panel, from dark (0) to bright (`scale`).
  void draw(const Grid& grid, int left, int top, int width, int height, double scale) {
    OIIO::ImageBuf values(OIIO::ImageSpec(width, height, 1, OIIO::TypeDesc::FLOAT));
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const float value = grid.at(x * grid.width() / width, y * grid.height() / height);
        const float shown = std::clamp(value / static_cast<float>(scale), 0.0F, 1.0F);
        values.setpixel(x, y, 0, &shown, 1);
      }
    }
    const OIIO::ImageBuf colours = OIIO::ImageBufAlgo::color_map(values, 0, "inferno");
    std::array<float, 3> pixel{};
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        if (grid.at(x * grid.width() / width, y * grid.height() / height) >= 0.0F) {
          colours.getpixel(x, y, 0, pixel.data(), 3);
          m_pixels.setpixel(left + x, top + y, 0, pixel.data(), 3);
        }
      }
    }
  }
  void line(double x1, double y1, double x2, double y2, const std::array<float, 3>& colour) {
    OIIO::ImageBufAlgo::render_line(m_pixels, static_cast<int>(std::lround(x1)), static_cast<int>(std::lround(y1)),
                                    static_cast<int>(std::lround(x2)), static_cast<int>(std::lround(y2)), colour);
  }
  void frame(int left, int top, int width, int height) {
    OIIO::ImageBufAlgo::render_box(m_pixels, left - 1, top - 1, left + width, top + height, {0.5F, 0.5F, 0.5F});
  }
  void text(int x, int y, const std::string& words, int size = 15) {
    OIIO::ImageBufAlgo::render_text(m_pixels, x, y, words, size, "DejaVuSans", {0.9F, 0.9F, 0.9F});
    m_pixels.geterror();  // no font: no words
  }
  void write(const std::filesystem::path& file) { writePixels(m_pixels, file, OIIO::TypeDesc::UINT8, "plot", "png"); }

 private:
  OIIO::ImageBuf m_pixels;
};

void drawChromaticities(Sheet& sheet, const sip::Comparison& comparison, const spectral::RgbSpace& space,
                        const spectral::Observer& observer, int left, double scale) {
  const Eigen::Matrix3d xyzFromRgb = space.xyzFromRgb();
  Grid grid(kCells, kCells);
  for (const auto& colour : comparison.colours) {
    const Eigen::Vector2d xy = spectral::chromaticity(xyzFromRgb * colour.rgb);
    if (colour.rgb.allFinite() && xy.y() > 0.0) {
      grid.add(static_cast<int>(std::floor(xy.x() / kChromaticitySpan * kCells)),
               kCells - 1 - static_cast<int>(std::floor(xy.y() / kChromaticitySpan * kCells)), colour.deltaE);
    }
  }
  sheet.draw(grid.filled(kReach), left, kMargin, kPanel, kPanel, scale);
  const auto at = [&](const Eigen::Vector2d& xy) -> Eigen::Vector2d {
    return {left + xy.x() / kChromaticitySpan * kPanel, kMargin + kPanel - xy.y() / kChromaticitySpan * kPanel};
  };
  const auto outline = [&](const std::vector<Eigen::Vector2d>& corners, const std::array<float, 3>& colour) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Eigen::Vector2d from = at(corners[i]);
      const Eigen::Vector2d to = at(corners[(i + 1) % corners.size()]);
      sheet.line(from.x(), from.y(), to.x(), to.y(), colour);
    }
  };
  std::vector<Eigen::Vector2d> locus;
  const auto curves = observer.onDomain();
  for (Eigen::Index nm = 10; nm < curves.rows() - 80; nm += 2) {
    locus.push_back(spectral::chromaticity(curves.row(nm).transpose()));
  }
  outline(locus, {0.75F, 0.75F, 0.75F});
  outline({space.primaries.begin(), space.primaries.end()}, {0.3F, 0.7F, 0.9F});
  sheet.frame(left, kMargin, kPanel, kPanel);
  sheet.text(left, kMargin - 8, "CIE xy, 0 to 0.9; largest difference of all exposures");
}

void drawExposures(Sheet& sheet, const sip::Comparison& comparison, const spectral::RgbSpace& space, int left,
                   double scale) {
  double lowest = 0.0;
  double highest = 0.0;
  for (const auto& colour : comparison.colours) {
    lowest = std::min(lowest, std::floor(colour.stop));
    highest = std::max(highest, std::floor(colour.stop));
  }
  const int stops = static_cast<int>(std::min(highest - lowest, 80.0)) + 1;
  const Eigen::Matrix3d xyzFromRgb = space.xyzFromRgb();
  const Eigen::Vector2d white = spectral::chromaticity(space.whiteXyz());
  Grid grid(stops, kHueCells);
  for (const auto& colour : comparison.colours) {
    if (!colour.rgb.allFinite()) {
      continue;
    }
    const Eigen::Vector2d away = spectral::chromaticity(xyzFromRgb * colour.rgb) - white;
    const double turn = std::atan2(away.y(), away.x()) / (2.0 * std::numbers::pi);
    const int hue = static_cast<int>(std::floor((turn < 0.0 ? turn + 1.0 : turn) * kHueCells));
    grid.add(static_cast<int>(std::floor(colour.stop - lowest)), kHueCells - 1 - std::min(hue, kHueCells - 1),
             colour.deltaE);
  }
  sheet.draw(grid, left, kMargin, kPanel, kPanel, scale);
  sheet.frame(left, kMargin, kPanel, kPanel);
  sheet.text(left, kMargin - 8, "hue round the white, 0 to 360 degrees upward, over exposure");
  sheet.text(left, kMargin + kPanel + 18, spectral::threeDigits(lowest) + " stops");
  sheet.text(left + kPanel - 70, kMargin + kPanel + 18, spectral::threeDigits(highest) + " stops");
}

void drawPicture(Sheet& sheet, const sip::Comparison& comparison, int width, int left, double scale) {
  const int height = static_cast<int>(comparison.colours.size() / static_cast<std::size_t>(width));
  const double factor = static_cast<double>(kPanel) / std::max(width, height);
  const int shownWidth = std::max(1, static_cast<int>(width * factor));
  const int shownHeight = std::max(1, static_cast<int>(height * factor));
  Grid grid(std::min(width, shownWidth), std::min(height, shownHeight));
  for (std::size_t i = 0; i < comparison.colours.size(); ++i) {
    const auto x = static_cast<std::int64_t>(i % static_cast<std::size_t>(width));
    const auto y = static_cast<std::int64_t>(i / static_cast<std::size_t>(width));
    grid.add(static_cast<int>(x * grid.width() / width), static_cast<int>(y * grid.height() / height),
             comparison.colours[i].deltaE);
  }
  sheet.draw(grid, left, kMargin, shownWidth, shownHeight, scale);
  sheet.frame(left, kMargin, shownWidth, shownHeight);
  sheet.text(left, kMargin - 8, "the picture");
}

void drawScale(Sheet& sheet, int left, double scale) {
  Grid grid(1, 256);
  for (int y = 0; y < 256; ++y) {
    grid.add(0, y, scale * (255 - y) / 255.0);
  }
  sheet.draw(grid, left, kMargin, kBar, kPanel, scale);
  sheet.frame(left, kMargin, kBar, kPanel);
  sheet.text(left, kMargin - 8, spectral::threeDigits(scale));
  sheet.text(left, kMargin + kPanel + 18, "0");
}

}  // namespace

void writeHeatMap(const std::filesystem::path& file, const sip::Comparison& comparison, const spectral::RgbSpace& space,
                  const spectral::Observer& standardObserver, const HeatMapOptions& options) {
  const int panels = options.pictureWidth > 0 ? 3 : 2;
  Sheet sheet(kMargin + panels * (kPanel + kMargin) + kBar + kMargin, kPanel + 2 * kMargin);
  sheet.text(kMargin, 22, options.title, 17);
  int left = kMargin;
  drawChromaticities(sheet, comparison, space, standardObserver, left, options.scale);
  left += kPanel + kMargin;
  drawExposures(sheet, comparison, space, left, options.scale);
  left += kPanel + kMargin;
  if (options.pictureWidth > 0) {
    drawPicture(sheet, comparison, options.pictureWidth, left, options.scale);
    left += kPanel + kMargin;
  }
  drawScale(sheet, left, options.scale);
  sheet.write(file);
}

}  // namespace metamer::lutgen
