// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/pixel_protocol.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "metamer/spectral/chromatic_adaptation.h"
#include "metamer/spectral/quantile.h"
#include "metamer/spectral/rgb_space.h"
#include "metamer/spectral/srgb_curve.h"
#include "operators/ap1.h"
#include "operators/parallel.h"

namespace metamer::ocio {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Darker pixels count as large as this: a thousandth of a camera's noise.
constexpr double kLeastSize = 1e-6;
constexpr const char* kPhotograph = "photograph";
constexpr const char* kNoisy = "noisy photograph";
constexpr const char* kSaturated = "saturated light";

const Eigen::Vector2d kD65(0.3127, 0.3290);

/// ACEScg, in which the pixels are kept.
spectral::RgbSpace acesCg() {
  return {"ACEScg", ap1Primaries(), {0.32168, 0.33767}};
}

/// An sRGB display's primaries (IEC 61966-2-1).
spectral::RgbSpace display() {
  return {"sRGB", {{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}}}, kD65};
}

Eigen::Matrix3d between(const spectral::RgbSpace& from, const spectral::RgbSpace& to) {
  return spectral::adaptRgb(spectral::ChromaticAdaptation::Bradford, from, to);
}

/// 8-bit code of a display, without rounding.
double codeOf(double linear) {
  return 255.0 * spectral::srgbFromLinear(std::clamp(linear, 0.0, 1.0));
}

}  // namespace

PixelProtocol::PixelProtocol(const sip::SpectralTransform& engine, const std::vector<spectral::SetPixel>& pixels)
    : m_engine(engine),
      m_pixels(pixels),
      m_expected(pixels.size()),
      m_displayFromRgb(between(engine.space(), display())) {
  const Eigen::Matrix3d fromSet = between(acesCg(), engine.space());
  constexpr std::size_t kBlock = 256;
  parallelFor(static_cast<int>((m_pixels.size() + kBlock - 1) / kBlock), [&](int block) {
    const std::size_t first = kBlock * static_cast<std::size_t>(block);
    const std::size_t count = std::min(kBlock, m_pixels.size() - first);
    for (std::size_t k = first; k < first + count; ++k) {
      // What a candidate sees.
      m_pixels[k].rgb = (fromSet * m_pixels[k].rgb).cast<float>().cast<double>();
      m_expected[k] = m_pixels[k].rgb;
    }
    m_engine.apply(std::span(m_expected).subspan(first, count));
  });
  const Eigen::RowVector3d luminance = engine.space().xyzFromRgb().row(1);
  const double white = luminance * engine.apply(Eigen::Vector3d(1.0, 1.0, 1.0));
  m_brightening = 0.0;
  for (std::size_t k = 0; k < m_pixels.size(); ++k) {
    if (m_pixels[k].kind == kSaturated) {
      m_brightening = std::max(m_brightening, luminance.dot(m_expected[k]) / luminance.dot(m_pixels[k].rgb) / white);
    }
  }
}

PixelProtocol::Report PixelProtocol::measure(const std::function<void(std::span<float> rgba)>& candidate) const {
  std::vector<float> rgba(4 * m_pixels.size());
  for (std::size_t k = 0; k < m_pixels.size(); ++k) {
    Eigen::Map<Eigen::Vector4f>(rgba.data() + 4 * k) << m_pixels[k].rgb.cast<float>(), 1.0F;
  }
  candidate(rgba);
  Report report;
  report.count = m_pixels.size();
  std::vector<double> distances;
  std::vector<double> photograph;
  std::vector<double> noisy;
  for (std::size_t k = 0; k < m_pixels.size(); ++k) {
    const auto& [kind, rgb] = m_pixels[k];
    const Eigen::Vector3d result = Eigen::Map<const Eigen::Vector3f>(rgba.data() + 4 * k).cast<double>();
    const double off = (result - m_expected[k]).cwiseAbs().maxCoeff();
    // maxCoeff passes over NaN.
    const bool isFinite = result.allFinite();
    const double distance = isFinite ? off / std::max(rgb.cwiseAbs().maxCoeff(), kLeastSize) : kInfinity;
    distances.push_back(distance);
    if (distance > report.largest) {
      report.largest = distance;
      report.worstKind = kind;
      report.worstRgb = rgb;
    }
    if (kind == kPhotograph || kind == kNoisy) {
      const auto codes = [&](const Eigen::Vector3d& light) -> Eigen::Vector3d {
        return (m_displayFromRgb * light).unaryExpr([](double channel) { return codeOf(channel); });
      };
      (kind == kNoisy ? noisy : photograph)
          .push_back(isFinite ? (codes(result) - codes(m_expected[k])).cwiseAbs().maxCoeff() : kInfinity);
    }
  }
  report.p999 = spectral::quantile(distances, 0.999);
  report.photographCodes = spectral::quantile(photograph, 0.99);
  report.noisyCodes = spectral::quantile(noisy, 0.99);
  return report;
}

}  // namespace metamer::ocio
