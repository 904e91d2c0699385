// SPDX-License-Identifier: Apache-2.0
#include "stage_pictures/chart_figure.h"

#include <OpenImageIO/imagebufalgo.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "metamer/spectral/chromatic_adaptation.h"
#include "metamer/spectral/srgb_curve.h"
#include "picture.h"

namespace metamer::lutgen {
namespace {

constexpr int kPatch = 64;  ///< pixels along a side
constexpr int kInner = 30;  ///< along the square in it
constexpr int kGap = 6;
constexpr float kGround = 0.12F;

std::array<float, 3> displayed(const Eigen::Vector3d& linear) {
  std::array<float, 3> result{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double value = std::clamp(linear[static_cast<Eigen::Index>(k)], 0.0, 1.0);
    result[k] = static_cast<float>(spectral::srgbFromLinear(value));
  }
  return result;
}

void fillSquare(OIIO::ImageBuf& canvas, int left, int top, int side, const std::array<float, 3>& colour) {
  OIIO::ImageBufAlgo::fill(canvas, colour, OIIO::ROI(left, left + side, top, top + side, 0, 1, 0, 3));
}

}  // namespace

void writeChartFigure(const std::vector<ChartComparison>& charts, int columns, const Eigen::Matrix3d& srgbFromCamera,
                      const std::filesystem::path& file) {
  const auto patches = static_cast<int>(charts.front().target.cols());
  const int across = std::min(columns, patches);
  const int down = (patches + across - 1) / across;
  const int chartHeight = down * (kPatch + kGap) + 2 * kGap;
  const int width = across * (kPatch + kGap) + kGap;
  OIIO::ImageBuf canvas(
      OIIO::ImageSpec(width, static_cast<int>(charts.size()) * chartHeight, 3, OIIO::TypeDesc::FLOAT));
  const std::array<float, 3> ground = {kGround, kGround, kGround};
  OIIO::ImageBufAlgo::fill(canvas, ground);
  for (std::size_t c = 0; c < charts.size(); ++c) {
    for (int i = 0; i < patches; ++i) {
      const int left = kGap + i % across * (kPatch + kGap);
      const int top = static_cast<int>(c) * chartHeight + kGap + i / across * (kPatch + kGap);
      fillSquare(canvas, left, top, kPatch, displayed(srgbFromCamera * charts[c].target.col(i)));
      constexpr int kInset = (kPatch - kInner) / 2;
      fillSquare(canvas, left + kInset, top + kInset, kInner, displayed(srgbFromCamera * charts[c].made.col(i)));
    }
  }
  writePixels(canvas, file, OIIO::TypeDesc::UINT8, "figure");
}

Eigen::Matrix3d displayFromCamera(const Eigen::Matrix3d& xyzFromCamera, const Eigen::Vector3d& whiteRgb,
                                  const Eigen::Matrix3d& rec709FromXyz, const Eigen::Vector3d& rec709White) {
  const Eigen::Vector3d white = xyzFromCamera * whiteRgb;
  if (!(white.minCoeff() > 0)) {
    return rec709FromXyz * xyzFromCamera;
  }
  return rec709FromXyz * spectral::adaptXyz(spectral::ChromaticAdaptation::Bradford, white / white.y(), rec709White) *
         xyzFromCamera / white.y();
}

}  // namespace metamer::lutgen
