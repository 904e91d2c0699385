// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

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
/// The plane is a triangle round all that can be seen: a wide cone of colours, to whose border colours from beyond are
/// cut before anything is divided by their sum. In it s and p1 are positive, before the transform and after, so that
/// nothing that a camera's noise makes can explode. Where the transform is its linear matrix, both frames give the same
/// coordinates, and the table is the identity there (unless what comes out asks for another sum).
struct ChromaticityPlane {
  /// Three coordinates of a colour that are not below zero within the cone.
  Eigen::Matrix3d coneFromRgb;
  ChromaticityFrame input;
  ChromaticityFrame output;
  Eigen::Vector2d white;     ///< the input's (a, b) of RGB (1, 1, 1)
  sip::SpectralLocus locus;  ///< the colours of all lights
  Eigen::Matrix3d xyzFromRgb;

  /// Whether a colour is one of those that errors are counted for: that lights can have.
  bool isVisible(const Eigen::Vector3d& rgb) const;
};

/// @param spec  what the transform was made from
ChromaticityPlane chromaticityPlane(const sip::TransformSpec& spec, const sip::SpectralTransform& transform);

}  // namespace metamer::ocio
