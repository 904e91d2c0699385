// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace metamer::sip {

/// Keeps what a guessed spectrum does to a colour within bounds around plain chromatic adaptation.
///
/// Colours are XYZ over white, fully adapted, so that plain adaptation leaves a colour as it is: v. With d what the
/// spectral result differs by and s = min(2, size / m), `m = max(d_Y / up, -d_Y / down, |d_X| / aside, |d_Z| / aside)`,
/// the result is `v + (s - s^2 / 4) d`. For Y the size is a = max(v_Y, 0): so luminance stays within
/// (1 - down) v_Y ... (1 + up) v_Y, and is plain where v_Y <= 0. For X and Z it is b = max(a, |v_X| / 8, |v_Z| / 8): Y
/// is small in blue, and a blue is not to be held to a part of that. The spectral result is untouched wherever m <= a
/// / 2. Continuous on all of R^3, homogeneous of degree one, with a continuous derivative where the limit sets in.
class Limiter {
 public:
  struct Reach {
    double up = 3.0;
    double down = 0.8;
    double aside = 4.0;
  };
  /// Reaches are raised at most to these.
  static constexpr Reach kMostReach = {3.5, 0.95, 12.0};
  /// Of X and Z, what may be lost.
  static constexpr double kMostLoss = 0.9;

  explicit Limiter(const Reach& reach) : m_reach(reach) {}

  /// A reach that leaves ordinary surfaces alone: raised to twice the 98th percentile of what they take.
  /// @param colours      v of the surfaces
  /// @param differences  d of the same surfaces
  static Reach reachFor(const std::vector<Eigen::Vector3d>& colours, const std::vector<Eigen::Vector3d>& differences);

  const Reach& reach() const { return m_reach; }

  /// Whether d is kept whole at v.
  bool keeps(const Eigen::Vector3d& colour, const Eigen::Vector3d& difference) const;

  struct Limited {
    Eigen::Vector3d value;
    Eigen::Matrix3d byColour;      ///< its derivative by v; of one side where there are two
    Eigen::Matrix3d byDifference;  ///< by d
  };
  /// The result at v for a difference d, with derivatives.
  Limited limited(const Eigen::Vector3d& colour, const Eigen::Vector3d& difference) const;
  /// The result alone.
  Eigen::Vector3d apply(const Eigen::Vector3d& colour, const Eigen::Vector3d& difference) const;

 private:
  Reach m_reach;
};

}  // namespace metamer::sip
