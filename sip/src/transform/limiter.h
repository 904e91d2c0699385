// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace metamer::sip {

/// Keeps what a guessed spectrum does to a colour within bounds around plain chromatic adaptation.
///
/// Colours are XYZ over white, fully adapted, so that plain adaptation leaves a colour as it is: v. With d what the
/// spectral result differs by, `a = max(v_Y, 0)` and `m = max(d_Y / up, -d_Y / down, |d_X| / aside, |d_Z| / aside)`, the
/// result is `v + (s - s^2 / 4) d`, s = min(2, a / m). So it is the spectral result wherever m <= a / 2, luminance stays
/// within (1 - down) v_Y ... (1 + up) v_Y, and nothing is left of d where v_Y <= 0. Continuous on all of R^3, homogeneous
/// of degree one, with a continuous derivative where the limit sets in.
class Limiter {
 public:
  struct Reach {
    double up = 3.0;
    double down = 0.8;
    double aside = 4.0;
  };
  /// Reaches are raised at most to these.
  static constexpr Reach kMostReach = {3.5, 0.95, 12.0};

  explicit Limiter(const Reach& reach) : m_reach(reach) {}

  /// A reach that leaves ordinary surfaces alone: raised to twice the 98th percentile of what they take.
  /// @param colours      v of the surfaces
  /// @param differences  d of the same surfaces
  static Reach reachFor(const std::vector<Eigen::Vector3d>& colours, const std::vector<Eigen::Vector3d>& differences);

  const Reach& reach() const { return m_reach; }

  struct Share {
    double value;              ///< of d that is kept: 0 ... 1
    Eigen::RowVector3d slope;  ///< by v, and by d
    Eigen::RowVector3d slopeByDifference;
  };
  /// Of d at v; the slopes are those of one side where there are two.
  Share share(const Eigen::Vector3d& colour, const Eigen::Vector3d& difference) const;

 private:
  Reach m_reach;
};

}  // namespace metamer::sip
