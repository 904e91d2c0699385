// SPDX-License-Identifier: Apache-2.0
#include "chain/chromaticity_probe.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "metamer/spectral/colorimetry.h"
#include "operators/perceptual_form.h"

namespace metamer::ocio {
namespace {

/// Where deviations are judged: the error protocol's luminance.
constexpr double kLuminance = 0.18;
/// Deviation of coordinates that the metric is taken by, and of the plane's that areas are.
constexpr double kStep = 1e-3;
constexpr double kAreaStep = 1e-5;
/// The ring: its part of the way to the border, which is found by halving.
constexpr double kRingPart = 0.97;
constexpr int kHalvings = 40;

}  // namespace

ChromaticityProbe::ChromaticityProbe(const ChromaticityPlane& plane, const sip::SpectralTransform& transform)
    : m_plane(plane),
      m_transform(transform),
      m_xyzFromRgb(transform.space().xyzFromRgb()),
      m_white(transform.whiteXyz()) {}

Eigen::Vector3d ChromaticityProbe::colourAt(const Eigen::Vector2d& point) const {
  const Eigen::Vector3d rgb = m_plane.input.colour({point.x(), point.y(), 0.0});
  const double y = m_xyzFromRgb.row(1) * rgb;
  return rgb * (kLuminance / std::max(y, 0.01 * rgb.norm()));
}

ChromaticityProbe::Answer ChromaticityProbe::answered(const Eigen::Vector3d& in, bool isFeasible) const {
  Answer answer;
  answer.in = in;
  answer.out = m_transform.apply(in);
  answer.amount = m_plane.input.coordinates(in)[2];
  answer.value = m_plane.output.coordinates(answer.out);
  answer.value[2] -= answer.amount;
  answer.isFeasible = isFeasible;
  answer.isUsable = answer.value.allFinite() && answer.value.cwiseAbs().maxCoeff() < 1e3;
  return answer;
}

ChromaticityProbe::Answer ChromaticityProbe::ask(const Eigen::Vector2d& point) const {
  const Eigen::Vector3d in = colourAt(point);
  return answered(in, m_plane.isFeasible(in));
}

ChromaticityProbe::Answer ChromaticityProbe::askFeasible(const Eigen::Vector2d& point) const {
  const Eigen::Vector3d in = colourAt(point);
  return m_plane.isFeasible(in) ? answered(in, true) : Answer{};
}

Eigen::Matrix3d ChromaticityProbe::metric(const Answer& answer) const {
  const Eigen::Vector3d centre = m_plane.output.coordinates(answer.out);
  const Eigen::Vector3d lab = spectral::lab(m_xyzFromRgb * answer.out, m_white);
  return perceptualForm(
      [&](const Eigen::Vector3d& deviation) {
        return spectral::deltaE2000(lab,
                                    spectral::lab(m_xyzFromRgb * m_plane.output.colour(centre + deviation), m_white));
      },
      kStep);
}

double ChromaticityProbe::error(const Answer& answer, const Eigen::Vector3d& value) const {
  const Eigen::Vector3d out = m_plane.output.colour(value + Eigen::Vector3d(0.0, 0.0, answer.amount));
  const double error = spectral::deltaE2000(spectral::lab(m_xyzFromRgb * answer.out, m_white),
                                            spectral::lab(m_xyzFromRgb * out, m_white));
  return std::isfinite(error) ? error : 0.0;
}

std::vector<Eigen::Vector2d> ChromaticityProbe::ring(int count) const {
  const Eigen::Matrix3d rgbFromXyz = m_xyzFromRgb.inverse();
  const Eigen::Vector2d white = spectral::chromaticity(m_white);
  std::vector<Eigen::Vector2d> points;
  for (int k = 0; k < count; ++k) {
    const double angle = 2.0 * std::numbers::pi * (k + 0.5) / count;
    const auto colourAlong = [&](double part) -> Eigen::Vector3d {
      return rgbFromXyz * spectral::xyzFromChromaticity(
                              white + part * Eigen::Vector2d(std::cos(angle), std::sin(angle)), kLuminance);
    };
    double inside = 0.0;
    double outside = 1.0;
    for (int halving = 0; halving < kHalvings; ++halving) {
      const double middle = 0.5 * (inside + outside);
      const bool isAbove = white.y() + middle * std::sin(angle) > 1e-6;
      (isAbove && m_plane.isFeasible(colourAlong(middle)) ? inside : outside) = middle;
    }
    points.emplace_back(m_plane.input.coordinates(colourAlong(kRingPart * inside)).head<2>());
  }
  return points;
}

double ChromaticityProbe::xyArea(const Eigen::Vector2d& point, double area) const {
  const auto xy = [&](double a, double b) {
    return spectral::chromaticity(m_xyzFromRgb * m_plane.input.colour({a, b, 0.0}));
  };
  const Eigen::Vector2d here = xy(point.x(), point.y());
  const Eigen::Vector2d first = (xy(point.x() + kAreaStep, point.y()) - here) / kAreaStep;
  const Eigen::Vector2d second = (xy(point.x(), point.y() + kAreaStep) - here) / kAreaStep;
  return area * std::abs(first.x() * second.y() - first.y() * second.x());
}

}  // namespace metamer::ocio
