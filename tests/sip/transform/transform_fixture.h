// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "metamer/sip/spectral_transform.h"
#include "sip/sip_fixture.h"

namespace metamer::sip {

/// Colours of everyday and worse: inside the gamut, on its border, far outside it.
std::vector<Eigen::Vector3d> colours(int count, unsigned seed = 3);

std::string pairName(const std::pair<std::string, std::string>& pair);

/// Response of a pipeline to a reflectance on the domain, as RGB that the input side of `transform` stands for.
Eigen::Vector3d inputRgb(const TransformSpec& spec, const SpectralTransform& transform,
                         const spectral::DomainSamples& reflectance);

/// What the output side makes of a reflectance, by the definition: CAT with the gain of `adaptation`, on XYZ.
Eigen::Vector3d outputRgb(const TransformSpec& spec, const spectral::DomainSamples& reflectance);

/// A light of one line, 2 nm wide at its foot.
spectral::Spectrum laser(double wavelengthNm);

/// A transform on XYZ over the working white: what its bounds are stated for.
class RelativeColours {
 public:
  /// @param transform  outlives this; at adaptation 1, without kept exposure
  explicit RelativeColours(const SpectralTransform& transform);

  Eigen::Vector3d apply(const Eigen::Vector3d& relative) const;
  Eigen::Matrix3d derivative(const Eigen::Vector3d& relative) const;
  /// The derivative's largest singular value.
  double steepness(const Eigen::Vector3d& relative) const;

  const Eigen::Matrix3d& relativeFromRgb() const { return m_relativeFromRgb; }
  Eigen::Vector3d fromXyz(const Eigen::Vector3d& xyz) const { return xyz.cwiseQuotient(m_transform.whiteXyz()); }

 private:
  const SpectralTransform& m_transform;
  Eigen::Matrix3d m_relativeFromRgb;
  Eigen::Matrix3d m_rgbFromRelative;
};

}  // namespace metamer::sip
