// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "metamer/spectral/uplift.h"

namespace metamer::spectral {

/// Jakob and Hanika 2019, "A low-dimensional function space for efficient spectral upsampling", Computer Graphics Forum
/// 38(2), sections 3 and 4: the coefficients whose spectrum is nearest to a colour in CIELAB (CIE 1976 difference).
class JakobSolver {
 public:
  static constexpr int kBands = 81;  ///< 380, 385, ..., 780 nm
  static std::vector<double> wavelengthsNm();

  struct Solution {
    Eigen::Vector3d coefficients;
    double error;  ///< CIE 1976 difference that is left
  };

  /// @param weights  kBands rows
  explicit JakobSolver(const UpliftWeights& weights);

  /// Levenberg and Marquardt's method from the grey of the colour's luminance; where that leaves a difference, from a
  /// few other places too, the best of them.
  Solution solve(const Eigen::Vector3d& xyz) const;
  /// From coefficients nearby; as solve() where that leaves a difference.
  Solution solveFrom(const Eigen::Vector3d& start, const Eigen::Vector3d& xyz) const;

  /// kBands reflectances.
  void spectrum(const Eigen::Vector3d& coefficients, double* values) const;

 private:
  /// Even, for whole pairs of doubles; the last has no weight.
  static constexpr int kRows = kBands + 1;
  using Rows = Eigen::Array<double, kRows, 1>;
  struct State {
    Eigen::Vector3d residual;    ///< CIELAB, from the target
    Eigen::Matrix3d derivative;  ///< of CIELAB by coefficients
  };

  State stateAt(const Eigen::Vector3d& coefficients, const Eigen::Vector3d& targetLab) const;
  Eigen::Vector3d labOf(const Eigen::Vector3d& xyz, Eigen::Vector3d* slopes) const;
  Solution descend(Eigen::Vector3d coefficients, const Eigen::Vector3d& targetLab) const;
  Solution fromOtherPlaces(Solution best, const Eigen::Vector3d& xyz, const Eigen::Vector3d& targetLab) const;

  Rows m_t;
  /// Weights times t², times t, and alone: three columns each.
  Eigen::Matrix<double, kRows, 9> m_weights;
  Eigen::Vector3d m_white;
};

}  // namespace metamer::spectral
