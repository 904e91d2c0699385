// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace metamer::sip {

/// Skins as one Gaussian of spectra. Its mean given a colour is linear in the colour, and so homogeneous: an exposure
/// changes nothing. What it is worth at a chromaticity is its share: `share exp(-(m / fade)^3 / 2)`, m the distance
/// from the skins' mean in their own standard deviations, and nothing at white, so that neutrals stay exact. By trial
/// the square is too little at ordinary skins, and the fourth power too steep: chromaticities fold beside it.
///
/// Places are chromaticities as MeasuredSeeds has them. Immutable.
class SkinGaussian {
 public:
  /// @param differences  n q from a response (MeasuredSeeds)
  /// @param weights      3 x nodes, each row's sum 1
  /// @param reflectances nodes x n skins, at least 4 that the light shows
  /// @param share        0 ... 1, the most that it counts beside other knowledge
  /// @param fade         above 0
  SkinGaussian(const Eigen::Matrix<double, 2, 3>& differences, const Eigen::Matrix3Xd& weights,
               const Eigen::MatrixXd& reflectances, double share, double fade);

  /// The mean spectra of the responses (1, 0, 0), (0, 1, 0) and (0, 0, 1), from which all others are summed, at the
  /// nodes, and below them their responses: (nodes + 3) x 3.
  const Eigen::MatrixX3d& spectra() const { return m_spectra; }

  /// A number or three, and how they change with the place.
  struct Share {
    double value;
    Eigen::Vector2d slope;
  };
  Share share(const Eigen::Vector2d& place) const;

  /// The response of mean one at a place, and its derivative by the place.
  Eigen::Vector3d response(const Eigen::Vector2d& place) const {
    return m_responseFromPlace.leftCols<2>() * place + m_responseFromPlace.col(2);
  }
  Eigen::Matrix<double, 3, 2> responseSlope() const { return m_responseFromPlace.leftCols<2>(); }

 private:
  Eigen::MatrixX3d m_spectra;
  Eigen::Matrix3d m_responseFromPlace;  ///< of (q, 1)
  Eigen::Vector2d m_centre;             ///< of the skins
  Eigen::Matrix2d m_precision;          ///< inverse covariance of their places
  double m_share;
  double m_fade;
};

}  // namespace metamer::sip
