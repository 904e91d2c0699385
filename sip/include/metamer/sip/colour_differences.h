// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>

namespace metamer::sip {

/// CIEDE2000 between wanted colours and given ones, many at once: spectral::deltaE2000 to about 1e-12, and the same
/// bits whatever the instruction set and however many colours come together (Sharma, Wu and Dalal 2005, eq. 2 to 22).
class ColourDifferences {
 public:
  /// @param xyzFromRgb  of the given colours
  /// @param whiteXyz    what CIELAB is relative to
  ColourDifferences(const Eigen::Matrix3d& xyzFromRgb, const Eigen::Vector3d& whiteXyz)
      : m_relativeFromRgb(whiteXyz.cwiseInverse().asDiagonal() * xyzFromRgb) {}

  /// @param lab     CIELAB of what is wanted
  /// @param rgb     what is there, linear, as many
  /// @param result  out: as many differences; infinite where one is no number
  void measure(std::span<const Eigen::Vector3d> lab, std::span<const Eigen::Vector3d> rgb,
               std::span<double> result) const;

 private:
  Eigen::Matrix3d m_relativeFromRgb;
};

}  // namespace metamer::sip
