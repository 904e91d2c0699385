// SPDX-License-Identifier: Apache-2.0
#include "stage_pictures/check_picture.h"

#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "metamer/spectral/srgb_curve.h"
#include "picture.h"

namespace metamer::lutgen {
namespace {

constexpr std::array<float, 3> kLine = {0.0F, 1.0F, 0.3F};

float displayed(float linear) {
  return static_cast<float>(spectral::srgbFromLinear(std::clamp(std::isfinite(linear) ? linear : 0.0F, 0.0F, 1.0F)));
}

void drawLine(OIIO::ImageBuf& canvas, const Eigen::Vector2d& from, const Eigen::Vector2d& to, int thickness) {
  const int steps = static_cast<int>(std::ceil((to - from).cwiseAbs().maxCoeff())) + 1;
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2d point = from + (to - from) * i / steps;
    const int x = static_cast<int>(point.x());
    const int y = static_cast<int>(point.y());
    OIIO::ImageBufAlgo::fill(canvas, kLine, OIIO::ROI(x, x + thickness, y, y + thickness, 0, 1, 0, 3));
  }
}

}  // namespace

void writeCheckPicture(const Picture& picture, const stage::ChartGrid& grid, const std::filesystem::path& file) {
  const OIIO::ImageSpec& spec = picture.pixels().spec();
  OIIO::ImageBuf canvas(OIIO::ImageSpec(spec.width, spec.height, 3, OIIO::TypeDesc::FLOAT));
  std::vector<float> channels(static_cast<std::size_t>(spec.nchannels));
  const auto pixel = [&](int x, int y) {
    picture.pixels().getpixel(spec.x + x, spec.y + y, channels.data(), spec.nchannels);
    std::array<float, 3> rgb{};
    for (std::size_t k = 0; k < 3; ++k) {
      rgb[k] = channels[static_cast<std::size_t>(picture.colours()[k])];
    }
    return rgb;
  };
  float brightest = 0;
  for (int row = 0; row < grid.rows(); ++row) {
    for (int column = 0; column < grid.columns(); ++column) {
      const Eigen::Vector2d middle = grid.pixelAt({column + 0.5, row + 0.5});
      for (const float value : pixel(static_cast<int>(middle.x()), static_cast<int>(middle.y()))) {
        brightest = std::isfinite(value) ? std::max(brightest, value) : brightest;
      }
    }
  }
  const float gain = brightest > 0 ? 1 / brightest : 1;
  for (int y = 0; y < spec.height; ++y) {
    for (int x = 0; x < spec.width; ++x) {
      auto rgb = pixel(x, y);
      std::transform(rgb.begin(), rgb.end(), rgb.begin(), [gain](float v) { return displayed(gain * v); });
      canvas.setpixel(x, y, rgb.data(), 3);
    }
  }
  const int thickness = std::max(1, std::max(spec.width, spec.height) / 600);
  for (int row = 0; row < grid.rows(); ++row) {
    for (int column = 0; column < grid.columns(); ++column) {
      const auto square = grid.sampledSquare(column, row);
      for (std::size_t i = 0; i < 4; ++i) {
        drawLine(canvas, square[i], square[(i + 1) % 4], thickness);
      }
      if (row == 0 && column == 0) {
        drawLine(canvas, square[0], square[2], thickness);
        drawLine(canvas, square[1], square[3], thickness);
      }
    }
  }
  writePixels(canvas, file, OIIO::TypeDesc::UINT8, "check picture");
}

}  // namespace metamer::lutgen
