// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>

#include "metamer/skin/skin_parameters.h"
#include "metamer/skin/skin_prior.h"

namespace metamer::skin {

/// A colour's noise as a share of its brightness: what the model is allowed to leave to the residual.
inline constexpr double kColourNoise = 0.01;

/// Finds the coordinates of the skin that is most probable under the prior and has a colour: least squares of the
/// colour's difference over kColourNoise times its brightness and of the whitened distance to the prior's mean, within
/// the ranges (Levenberg and Marquardt; what is at its border and would leave stays).
class MostProbable {
 public:
  using Colour = std::function<Eigen::Vector3d(const SkinCoordinates&)>;
  using Jacobian = Eigen::Matrix<double, 3, 5>;

  MostProbable(const SkinPrior& prior, Colour colour);

  /// @param start  any coordinates within the ranges; near the answer saves time
  SkinCoordinates of(const Eigen::Vector3d& rgb, const SkinCoordinates& start) const;

  /// How the colour goes with the coordinates.
  Jacobian slope(const SkinCoordinates& at, const Eigen::Vector3d& colour) const;
  const Eigen::Matrix<double, 5, 5>& precision() const { return m_precision; }
  /// The coordinates' ranges: from no melanin, no blood on.
  const SkinCoordinates& lowest() const { return m_lowest; }
  const SkinCoordinates& highest() const { return m_highest; }

 private:
  double cost(const SkinCoordinates& at, const Eigen::Vector3d& difference, double perNoise) const;

  Colour m_colour;
  SkinCoordinates m_mean;
  SkinCoordinates m_step;
  SkinCoordinates m_lowest;
  SkinCoordinates m_highest;
  Eigen::Matrix<double, 5, 5> m_precision;
};

}  // namespace metamer::skin
