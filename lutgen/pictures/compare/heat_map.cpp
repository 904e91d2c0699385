// SPDX-License-Identifier: Apache-2.0
#include "compare/heat_map.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "compare/error_scale.h"
#include "metamer/spectral/colorimetry.h"
#include "metamer/spectral/formatted.h"
#include "picture.h"

namespace metamer::lutgen {
namespace {

constexpr float kBackground = 0.15F;
constexpr float kNothing = -1.0F;  ///< no colour fell here
constexpr int kTop = 72;           ///< title and the panels' titles
constexpr int kBelow = 84;         ///< ticks, the axis' title, the legend
constexpr int kLeft = 76;          ///< of each panel: ticks and their names
constexpr int kPanel = 460;
constexpr int kBar = 18;
constexpr int kBarWords = 190;
constexpr int kTick = 5;
constexpr int kSmall = 13;                 ///< of letters
constexpr double kChromaticitySpan = 0.9;  ///< of x and y from 0
using Colour = std::array<float, 3>;
constexpr Colour kLocusColour = {0.75F, 0.75F, 0.75F};
constexpr Colour kGamutColour = {0.3F, 0.7F, 0.9F};
constexpr Colour kInk = {0.9F, 0.9F, 0.9F};
constexpr Colour kFrame = {0.5F, 0.5F, 0.5F};
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

using AlignX = OIIO::ImageBufAlgo::TextAlignX;
using AlignY = OIIO::ImageBufAlgo::TextAlignY;

/// A font where systems keep it: OpenImageIO looks for names in the fonts' folder itself alone. Its name where it is
/// nowhere here, for OPENIMAGEIO_FONTS.
std::string fontFile() {
  for (const char* file :
       {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
        "/usr/share/fonts/TTF/DejaVuSans.ttf", "/Library/Fonts/Arial.ttf", "C:/Windows/Fonts/arial.ttf"}) {
    std::error_code none;
    if (std::filesystem::exists(file, none)) {
      return file;
    }
  }
  return "DejaVuSans";
}

/// The sheet that panels are drawn on.
class Sheet {
 public:
  Sheet(int width, int height) : m_pixels(OIIO::ImageSpec(width, height, 3, OIIO::TypeDesc::FLOAT)) {
    OIIO::ImageBufAlgo::fill(m_pixels, {kBackground, kBackground, kBackground});
  }

  /// A grid scaled to a panel, from dark to bright.
  void draw(const Grid& grid, int left, int top, int width, int height, const ErrorScale& scale) {
    OIIO::ImageBuf values(OIIO::ImageSpec(width, height, 1, OIIO::TypeDesc::FLOAT));
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const float value = grid.at(x * grid.width() / width, y * grid.height() / height);
        const auto shown = static_cast<float>(scale.share(value));
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
  void line(double x1, double y1, double x2, double y2, const Colour& colour) {
    OIIO::ImageBufAlgo::render_line(m_pixels, static_cast<int>(std::lround(x1)), static_cast<int>(std::lround(y1)),
                                    static_cast<int>(std::lround(x2)), static_cast<int>(std::lround(y2)), colour);
  }
  void frame(int left, int top, int width, int height) {
    OIIO::ImageBufAlgo::render_box(m_pixels, left - 1, top - 1, left + width, top + height, kFrame);
  }
  void text(double x, double y, const std::string& words, int size = 15, AlignX alignX = AlignX::Left,
            AlignY alignY = AlignY::Baseline) {
    OIIO::ImageBufAlgo::render_text(m_pixels, static_cast<int>(std::lround(x)), static_cast<int>(std::lround(y)), words,
                                    size, m_font, kInk, alignX, alignY);
    m_pixels.geterror();  // no font: no words
  }
  /// A tick below a panel, with its words.
  void tickBelow(double x, const std::string& words) {
    line(x, kTop + kPanel, x, kTop + kPanel + kTick, kFrame);
    text(x, kTop + kPanel + kTick + 3, words, kSmall, AlignX::Center, AlignY::Top);
  }
  /// A tick at the left of a panel, with its words.
  void tickLeft(int left, double y, const std::string& words) {
    line(left - kTick, y, left, y, kFrame);
    text(left - kTick - 4, y, words, kSmall, AlignX::Right, AlignY::Center);
  }
  /// A legend's entry in the last line of a panel.
  void legend(double x, const Colour& colour, const std::string& words) {
    const double y = kTop + kPanel + kBelow - 18;
    line(x, y, x + 24, y, colour);
    text(x + 32, y, words, kSmall, AlignX::Left, AlignY::Center);
  }
  void panelTitle(int left, const std::string& words) { text(left, kTop - 10, words); }
  void axisTitle(int left, const std::string& words) {
    text(left + kPanel / 2.0, kTop + kPanel + 24, words, kSmall, AlignX::Center, AlignY::Top);
  }
  void write(const std::filesystem::path& file) { writePixels(m_pixels, file, OIIO::TypeDesc::UINT8, "plot", "png"); }

 private:
  OIIO::ImageBuf m_pixels;
  std::string m_font = fontFile();
};

/// Where a chromaticity lies in its panel.
Eigen::Vector2d placeOf(const Eigen::Vector2d& xy, int left) {
  return {left + xy.x() / kChromaticitySpan * kPanel, kTop + kPanel - xy.y() / kChromaticitySpan * kPanel};
}

void outline(Sheet& sheet, const std::vector<Eigen::Vector2d>& corners, int left, const Colour& colour) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d from = placeOf(corners[i], left);
    const Eigen::Vector2d to = placeOf(corners[(i + 1) % corners.size()], left);
    sheet.line(from.x(), from.y(), to.x(), to.y(), colour);
  }
}

void drawChromaticities(Sheet& sheet, const sip::Comparison& comparison, const spectral::RgbSpace& space,
                        const spectral::Observer& observer, int left, const HeatMapOptions& options) {
  const Eigen::Matrix3d xyzFromRgb = space.xyzFromRgb();
  Grid grid(kCells, kCells);
  for (const auto& colour : comparison.colours) {
    const Eigen::Vector2d xy = spectral::chromaticity(xyzFromRgb * colour.rgb);
    if (colour.rgb.allFinite() && xy.y() > 0.0) {
      grid.add(static_cast<int>(std::floor(xy.x() / kChromaticitySpan * kCells)),
               kCells - 1 - static_cast<int>(std::floor(xy.y() / kChromaticitySpan * kCells)), colour.deltaE);
    }
  }
  sheet.draw(grid.filled(kReach), left, kTop, kPanel, kPanel, options.scale);
  std::vector<Eigen::Vector2d> locus;
  const auto curves = observer.onDomain();
  for (Eigen::Index nm = 10; nm < curves.rows() - 80; nm += 2) {
    locus.push_back(spectral::chromaticity(curves.row(nm).transpose()));
  }
  outline(sheet, locus, left, kLocusColour);
  outline(sheet, {space.primaries.begin(), space.primaries.end()}, left, kGamutColour);
  sheet.frame(left, kTop, kPanel, kPanel);
  for (const double value : {0.0, 0.2, 0.4, 0.6, 0.8}) {
    const Eigen::Vector2d place = placeOf({value, value}, left);
    sheet.tickBelow(place.x(), spectral::formatted("%.1f", value));
    sheet.tickLeft(left, place.y(), spectral::formatted("%.1f", value));
  }
  sheet.panelTitle(left, "by chromaticity: the largest of all exposures");
  sheet.axisTitle(left, "CIE 1931 x; upward y");
  sheet.legend(left, kLocusColour, "all colours there are");
  sheet.legend(left + kPanel / 2.0, kGamutColour, "gamut of " + options.spaceName);
}

/// Round the white, 0 ... 1 from the right over the top.
double hueOf(const Eigen::Vector3d& xyz, const Eigen::Vector2d& white) {
  const Eigen::Vector2d away = spectral::chromaticity(xyz) - white;
  const double turn = std::atan2(away.y(), away.x()) / (2.0 * std::numbers::pi);
  return turn < 0.0 ? turn + 1.0 : turn;
}

void drawExposures(Sheet& sheet, const sip::Comparison& comparison, const spectral::RgbSpace& space, int left,
                   const ErrorScale& scale) {
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
    const int hue = static_cast<int>(std::floor(hueOf(xyzFromRgb * colour.rgb, white) * kHueCells));
    grid.add(static_cast<int>(std::floor(colour.stop - lowest)), kHueCells - 1 - std::min(hue, kHueCells - 1),
             colour.deltaE);
  }
  sheet.draw(grid, left, kTop, kPanel, kPanel, scale);
  sheet.frame(left, kTop, kPanel, kPanel);
  for (const auto& [name, rgb] : {std::pair("red", Eigen::Vector3d(1, 0, 0)),
                                  {"yellow", {1, 1, 0}},
                                  {"green", {0, 1, 0}},
                                  {"cyan", {0, 1, 1}},
                                  {"blue", {0, 0, 1}},
                                  {"magenta", {1, 0, 1}}}) {
    sheet.tickLeft(left, kTop + kPanel * (1.0 - hueOf(xyzFromRgb * rgb, white)), name);
  }
  const int step = stops > 40 ? 10 : stops > 16 ? 5 : stops > 8 ? 2 : 1;
  for (int stop = static_cast<int>(std::ceil(lowest / step)) * step; stop <= lowest + stops - 1; stop += step) {
    sheet.tickBelow(left + (stop - lowest + 0.5) / stops * kPanel, spectral::formatted(stop == 0 ? "%d" : "%+d", stop));
  }
  sheet.panelTitle(left, "by hue and exposure");
  sheet.axisTitle(left, "stops from 18 % grey; upward hue, round the white");
}

void drawPicture(Sheet& sheet, const sip::Comparison& comparison, int width, int left, const ErrorScale& scale) {
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
  sheet.draw(grid, left, kTop, shownWidth, shownHeight, scale);
  sheet.frame(left, kTop, shownWidth, shownHeight);
  sheet.panelTitle(left, spectral::formatted("in the picture, %d x %d", width, height));
}

void drawScale(Sheet& sheet, int left, const HeatMapOptions& options) {
  const ErrorScale& scale = options.scale;
  Grid grid(1, kPanel);
  for (int y = 0; y < kPanel; ++y) {
    grid.add(0, y, scale.value(1.0 - (y + 0.5) / kPanel));
  }
  sheet.draw(grid, left, kTop, kBar, kPanel, scale);
  sheet.frame(left, kTop, kBar, kPanel);
  sheet.panelTitle(left, "CIEDE2000");
  const auto mark = [&](double value, const std::string& words, const Colour& colour) {
    const double y = kTop + kPanel * (1.0 - scale.share(value));
    sheet.line(left + kBar, y, left + kBar + kTick, y, colour);
    sheet.text(left + kBar + kTick + 4, y, words, kSmall, AlignX::Left, AlignY::Center);
  };
  for (const ErrorMark& one : scale.marks()) {
    // Words of a tolerance stand in place of those next to it.
    if (!options.tolerance ||
        std::abs(scale.share(one.value) - scale.share(*options.tolerance)) * kPanel > kSmall + 3) {
      mark(one.value, one.words, kFrame);
    }
  }
  if (options.tolerance) {
    mark(*options.tolerance, spectral::formatted("%g  the tolerance", *options.tolerance), kGamutColour);
    const double y = kTop + kPanel * (1.0 - scale.share(*options.tolerance));
    sheet.line(left - kTick, y, left + kBar + kTick, y, kGamutColour);
  }
}

}  // namespace

void writeHeatMap(const std::filesystem::path& file, const sip::Comparison& comparison, const spectral::RgbSpace& space,
                  const spectral::Observer& standardObserver, const HeatMapOptions& options) {
  const int panels = options.pictureWidth > 0 ? 3 : 2;
  Sheet sheet(panels * (kLeft + kPanel) + kLeft + kBar + kBarWords, kTop + kPanel + kBelow);
  sheet.text(kLeft, 26, options.title, 17);
  int left = kLeft;
  drawChromaticities(sheet, comparison, space, standardObserver, left, options);
  left += kPanel + kLeft;
  drawExposures(sheet, comparison, space, left, options.scale);
  left += kPanel + kLeft;
  if (options.pictureWidth > 0) {
    drawPicture(sheet, comparison, options.pictureWidth, left, options.scale);
    left += kPanel + kLeft;
  }
  drawScale(sheet, left, options);
  sheet.write(file);
}

}  // namespace metamer::lutgen
