// SPDX-License-Identifier: Apache-2.0
#include "chain/chain_probe.h"

#include <Eigen/LU>
#include <algorithm>

#include "chain/hexcone.h"
#include "metamer/spectral/colorimetry.h"
#include "operators/perceptual_form.h"

namespace metamer::ocio {
namespace {

/// Where deviations are judged: the error protocol's luminance.
constexpr double kLuminance = 0.18;
/// Deviation of logarithms that the metric is taken by.
constexpr double kStep = 1e-3;
/// Darkest luminance, over the largest channel, that is brought to kLuminance.
constexpr double kLeastLuminance = 1e-3;

}  // namespace

ChainProbe::ChainProbe(const ChainFrame& frame, const sip::TransformSpec& spec, const sip::SpectralTransform& transform)
    : m_frame(frame),
      m_transform(transform),
      m_rgbFromInput(frame.inputFromRgb.inverse()),
      m_xyzFromRgb(spec.space.xyzFromRgb()),
      m_xyzFromOutput(m_xyzFromRgb * frame.outputFromRgb.inverse()),
      m_white(transform.whiteXyz()),
      m_locus(spec.standardObserver) {}

Eigen::Vector3d ChainProbe::colourAt(const Eigen::Vector2d& point, double value) const {
  return m_rgbFromInput * colourOf({point.x(), 2.0 * point.y(), value});
}

std::vector<Eigen::Vector3d> ChainProbe::ratiosAt(const std::vector<Eigen::Vector2d>& points, double value) const {
  std::vector<Eigen::Vector3d> ratios;
  ratios.reserve(points.size());
  for (const Eigen::Vector2d& point : points) {
    ratios.push_back(colourAt(point, value));
  }
  m_transform.apply(ratios);
  for (Eigen::Vector3d& ratio : ratios) {
    ratio = m_frame.outputFromRgb * ratio;
  }
  return ratios;
}

bool ChainProbe::isLight(const Eigen::Vector2d& point) const {
  const Eigen::Vector3d xyz = m_xyzFromRgb * colourAt(point, 1.0);
  return xyz.y() > 0.0 && xyz.sum() > 0.0 && m_locus.contains(xyz.head<2>() / xyz.sum());
}

double ChainProbe::exposureAt(const Eigen::Vector2d& point) const {
  return kLuminance / std::max((m_xyzFromRgb * colourAt(point, 1.0)).y(), kLeastLuminance);
}

Eigen::Vector3d ChainProbe::labOf(double exposure, const Eigen::Vector3d& logRatio) const {
  const Eigen::Vector3d ratio = logRatio.unaryExpr([](double log) { return std::exp2(log); });
  return spectral::lab(exposure * (m_xyzFromOutput * ratio), m_white);
}

double ChainProbe::difference(const Eigen::Vector2d& point, const Eigen::Vector3d& logRatio,
                              const Eigen::Vector3d& other) const {
  const double exposure = exposureAt(point);
  return spectral::deltaE2000(labOf(exposure, logRatio), labOf(exposure, other));
}

Eigen::Matrix3d ChainProbe::metric(const Eigen::Vector2d& point, const Eigen::Vector3d& logRatio) const {
  const double exposure = exposureAt(point);
  const Eigen::Vector3d lab = labOf(exposure, logRatio);
  return perceptualForm(
      [&](const Eigen::Vector3d& deviation) {
        return spectral::difference2000(lab, labOf(exposure, logRatio + deviation));
      },
      kStep);
}

}  // namespace metamer::ocio
