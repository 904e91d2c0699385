// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "metamer/spectral/observer.h"

namespace metamer::sip {

/// The chromaticities of all lights: the region that an observer's spectral locus and its purple line enclose.
class SpectralLocus {
 public:
  /// @param observer  a CIE observer: its curves are XYZ
  /// @throws spectral::InputError for an observer of another response
  explicit SpectralLocus(const spectral::Observer& observer);

  bool contains(const Eigen::Vector2d& xy) const;

  /// Its corners, xy: convex, counter-clockwise.
  const std::vector<Eigen::Vector2d>& corners() const { return m_corners; }

  /// How far it is from a chromaticity inside to the border.
  /// @param direction  of unit length
  double distanceFrom(const Eigen::Vector2d& xy, const Eigen::Vector2d& direction) const;

 private:
  std::vector<Eigen::Vector2d> m_corners;
};

}  // namespace metamer::sip
