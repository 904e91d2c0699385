// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace metamer::sip {

/// A pair of pipelines as far as its conditioning goes, on the bands that decide it.
struct PairWeights {
  Eigen::Matrix3Xd input;                 ///< white-normalised response from reflectance, 3 x B
  Eigen::Matrix3Xd relativeFromSpectrum;  ///< adapted XYZ over white from reflectance, 3 x B
  Eigen::Matrix3d relativeFromResponse;   ///< the same from response, by plain adaptation
};

/// The bands on which a pair's relaxation is decided, whatever it is solved on later.
inline constexpr int kDecisionBandCount = 81;
/// A pair whose gain exceeds this is relaxed until it does not.
inline constexpr double kLargestGain = 3.0;

/// How much of a smooth spectrum's response is asked for, so that ordinary colours are not amplified.
///
/// The gain of the linear transform at a surface's colour is CIEDE2000 out per CIEDE2000 in, worst direction, small
/// step. Where its 95th percentile over the surfaces exceeds kLargestGain (a lamp that hardly tells two channels
/// apart), the tristimulus is met only as far as keeps it there; the rest takes plain adaptation.
/// @param pair      on kDecisionBandCount bands
/// @param surfaces  reflectances, B x n; not empty
/// @return SoftBoundSolver's relaxation for kDecisionBandCount bands; 0: exact
double relaxationOf(const PairWeights& pair, const Eigen::MatrixXd& surfaces);

/// 95th percentile of the gain of the linear transform at the surfaces' colours, for a relaxation as above. Infinite
/// for relaxation 0 where the light does not tell three channels apart.
double gainOf(const PairWeights& pair, const Eigen::MatrixXd& surfaces, double relaxation);

}  // namespace metamer::sip
