// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace metamer::sip {

/// Matern's kernel of order 3/2 between a place of a plane and a set of places, all of them at once:
/// `(1 + t) exp(-t)`, t the distance. The same bits whatever the instruction set; exp to about two units of the last
/// place.
class SampleKernel {
 public:
  SampleKernel() = default;
  /// @param places  n x 2, in units of the kernel's own length
  explicit SampleKernel(const Eigen::ArrayX2d& places);

  /// Numbers that values() gives.
  Eigen::Index rows() const { return static_cast<Eigen::Index>(m_x.size()); }

  /// Of a finite place; after the n values come up to 7 without a meaning, which fill the last vector.
  Eigen::VectorXd values(const Eigen::Vector2d& place) const;
  /// @param kernel  out: rows() numbers
  void values(const Eigen::Vector2d& place, Eigen::Ref<Eigen::VectorXd> kernel) const;
  /// Values, and their derivatives by the place's two coordinates, in three columns; rows as above.
  Eigen::MatrixX3d valuesAndSlopes(const Eigen::Vector2d& place) const;

 private:
  std::vector<double> m_x;  ///< padded to whole vectors
  std::vector<double> m_y;
};

}  // namespace metamer::sip
