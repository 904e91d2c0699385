// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <utility>

namespace metamer::sip {

/// How far places of a plane reach round themselves: 1 at each of them, smoothly down to 0 at its radius (Wendland's
/// function of second order), `1 - product(1 - bump)` of all together. Immutable.
class Cover {
 public:
  Cover() = default;
  /// @param places  2 x n
  /// @param radii   n, above 0, in units of the plane
  Cover(Eigen::Matrix2Xd places, Eigen::VectorXd radii) : m_places(std::move(places)), m_radii(std::move(radii)) {}

  bool isEmpty() const { return m_places.cols() == 0; }
  const Eigen::VectorXd& radii() const { return m_radii; }

  /// A number and how it changes with the place.
  struct Share {
    double value = 0.0;
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  };
  Share at(const Eigen::Vector2d& place) const;

 private:
  Eigen::Matrix2Xd m_places;
  Eigen::VectorXd m_radii;
};

}  // namespace metamer::sip
