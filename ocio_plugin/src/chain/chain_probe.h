// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "chain/chain_frame.h"
#include "metamer/sip/spectral_locus.h"
#include "metamer/sip/spectral_transform.h"

namespace metamer::ocio {

/// Asks a transform about colours by hue and half their saturation (both 0 ... 1), and judges what a table gives there.
class ChainProbe {
 public:
  /// @param frame, transform  must outlive the probe
  ChainProbe(const ChainFrame& frame, const sip::TransformSpec& spec, const sip::SpectralTransform& transform);

  /// Where a value of 1 or -1 goes at some points: the output's channels.
  /// @param value  1 or -1
  std::vector<Eigen::Vector3d> ratiosAt(const std::vector<Eigen::Vector2d>& points, double value) const;

  /// Whether a point, above zero, is a colour of light: one by which the error protocol may judge.
  bool isLight(const Eigen::Vector2d& point) const;

  /// CIEDE2000 at the error protocol's luminance, between logarithms (base 2) of a light's ratios.
  double difference(const Eigen::Vector2d& point, const Eigen::Vector3d& logRatio, const Eigen::Vector3d& other) const;
  /// The same as a quadratic form of small deviations.
  Eigen::Matrix3d metric(const Eigen::Vector2d& point, const Eigen::Vector3d& logRatio) const;

 private:
  Eigen::Vector3d colourAt(const Eigen::Vector2d& point, double value) const;
  /// What brings a point's colour of value 1 to the protocol's luminance.
  double exposureAt(const Eigen::Vector2d& point) const;
  Eigen::Vector3d labOf(double exposure, const Eigen::Vector3d& logRatio) const;

  const ChainFrame& m_frame;
  const sip::SpectralTransform& m_transform;
  Eigen::Matrix3d m_rgbFromInput;
  Eigen::Matrix3d m_xyzFromRgb;
  Eigen::Matrix3d m_xyzFromOutput;
  Eigen::Vector3d m_white;
  sip::SpectralLocus m_locus;
};

}  // namespace metamer::ocio
