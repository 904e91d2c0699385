// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "metamer/sip/spectral_locus.h"
#include "metamer/sip/spectral_transform.h"

namespace metamer::ocio {

/// Projective coordinates of linear RGB: where a colour lies in the plane of chromaticity, and how much of it there is.
///
/// With p = fromRgb * rgb and s = p0 + p1 + p2: a = p0 / s, b = p1 / s - offset, amount = log2(p1).
struct ChromaticityFrame {
  Eigen::Matrix3d fromRgb = Eigen::Matrix3d::Identity();
  double offset = 1.0;  ///< keeps p1 well above zero wherever s is

  /// (a, b, amount) of a colour. The amount is NaN where p1 is not positive.
  Eigen::Vector3d coordinates(const Eigen::Vector3d& rgb) const;
  /// The colour with given coordinates.
  Eigen::Vector3d colour(const Eigen::Vector3d& coordinates) const;
};

/// The frames between which a spectral transform is tabulated.
///
/// All that the input's observer can see lies in the unit square of the input's (a, b), and s and p1 are positive on
/// all of it and on all that comes out. Where the transform is its unconstrained matrix, both frames give the same
/// coordinates, so that the table is the identity there (unless the matrix is too nearly singular for that).
struct ChromaticityPlane {
  ChromaticityFrame input;
  ChromaticityFrame output;
  Eigen::Vector2d white;     ///< the input's (a, b) of RGB (1, 1, 1)
  sip::SpectralLocus locus;  ///< the colours of all lights
  Eigen::Matrix3d xyzFromRgb;

  bool isFeasible(const Eigen::Vector3d& rgb) const {
    const Eigen::Vector3d xyz = xyzFromRgb * rgb;
    return xyz.sum() > 0.0 && locus.contains(xyz.head<2>() / xyz.sum());
  }
};

/// Planes worth trying for a transform, at least one. They differ in how they stretch chromaticities.
/// @param spec  what the transform was made from
std::vector<ChromaticityPlane> chromaticityPlanes(const sip::TransformSpec& spec,
                                                  const sip::SpectralTransform& transform);

}  // namespace metamer::ocio
