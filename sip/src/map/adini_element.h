// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

namespace metamer::sip {

/// Adini's element: twelve terms, each an RGB, in the order of HomogeneousMap::Patch.
using Adini = std::array<Eigen::Vector3d, 12>;

/// What an element takes at a corner.
struct AdiniCorner {
  Eigen::Vector3d value;
  Eigen::Vector3d alongU;  ///< derivative per unit of the first coordinate
  Eigen::Vector3d alongV;
};

/// The element over a square's corners (low-low, high-low, low-high, high-high): a cubic along each edge by the values
/// and derivatives at its ends. Neighbours of one size share their edge exactly.
/// @param side  of the square
Adini adiniElement(const std::array<AdiniCorner, 4>& corners, double side);

/// @param u, v  0 ... 1 over the square
inline Eigen::Vector3d evaluate(const Adini& patch, double u, double v) {
  const Eigen::Vector3d constant = ((patch[3] * u + patch[2]) * u + patch[1]) * u + patch[0];
  const Eigen::Vector3d linear = ((patch[7] * u + patch[6]) * u + patch[5]) * u + patch[4];
  return (((patch[11] * u + patch[10]) * v + (patch[9] * u + patch[8])) * v + linear) * v + constant;
}

}  // namespace metamer::sip
