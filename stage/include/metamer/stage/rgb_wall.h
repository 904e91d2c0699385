// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace metamer::stage {

/// What the camera saw of an RGB wall (section 2.7), all in its linear RGB, patches as columns.
struct WallCapture {
  Eigen::Matrix3d cameraFromWall;          ///< [SL]: columns are the wall's red, green and blue as the camera saw them
  std::array<Eigen::Matrix3Xd, 3> charts;  ///< C_k: the chart lit by the calibration square, one channel at a time
  Eigen::Matrix3Xd target;                 ///< T: the chart in the real place
  std::vector<std::string> patchNames;     ///< one a column of the charts
  Eigen::Vector3d environmentWhite;        ///< w_avg: what a white chart would send back of the environment
  double beta = 1;                         ///< see calibrationSquareBeta; above 0
  Eigen::Vector3d blackLevel = Eigen::Vector3d::Zero();  ///< b: the unlit part of the wall, as the camera saw it
};

/// The condition number of Q from which on N is bounded, unless the caller says otherwise.
inline constexpr double kDefaultLargestCondition = 100;
/// Bounds of N that are weighed against each other.
inline constexpr std::array<double, 5> kTradeOffLimits = {5, 10, 20, 50, 100};

struct WallOptions {
  int heldPatch = -1;            ///< patch whose colour Q holds exactly (white); -1: none
  Eigen::VectorXd patchWeights;  ///< weight of each patch in Q's sum of squares, not negative; empty: 1
  double largestCondition = kDefaultLargestCondition;  ///< 1 or more
  /// The same wall and place with skins in place of the chart, which Q then counts too; their names are not looked at.
  std::optional<WallCapture> skins = std::nullopt;
  double skinWeight = 0;  ///< of each skin in Q's sum of squares, not negative
};

/// What bounding N at one condition number of Q costs and buys.
struct WallTradeOff {
  double conditionLimit = 0;
  double gain = 0;          ///< largest singular value of Q^-1 as bounded: how much N amplifies over M
  double frustumError = 0;  ///< |Q [SL] N - 1|, largest singular value: 0 where the background keeps its colours
};

struct WallSolution {
  Eigen::Matrix3d wallFromContent;        ///< M, out of frustum: wall drives from camera RGB
  Eigen::Matrix3d correctedFromCamera;    ///< Q, after the camera
  Eigen::Matrix3d frustumFromContent;     ///< N, in frustum
  Eigen::Vector3d frustumOffset;          ///< -M b, added to what N gives; drives then never below 0
  Eigen::Vector3d environmentDrive;       ///< M w_avg with negatives at 0
  Eigen::Vector3d environmentDriveAsked;  ///< M w_avg
  Eigen::Matrix3Xd predicted;             ///< P
  Eigen::Matrix3Xd corrected;             ///< Q P
  Eigen::Matrix3Xd predictedSkins;        ///< P of the skins; empty without them
  Eigen::Matrix3Xd correctedSkins;        ///< Q P of them
  double wallCondition = 0;               ///< of [SL]
  double chartCondition = 0;              ///< of P
  double correctionCondition = 0;         ///< of Q; infinite at rank one
  int chartRank = 0;                      ///< independent patches, at most 3
  bool bounded = false;                   ///< N is not M Q^-1 but bounded
  std::vector<WallTradeOff> tradeOffs;    ///< at several limits, where the condition number of Q is above 10
};

/// M = [SL]^-1; P = beta sum_k C_k (M w)_k; Q = argmin |Q P - T|, with one patch held where asked; N = M Q^-1; offset
/// -M b (sections 2.7.2.1 to 2.7.3).
///
/// The wall cannot show negative light: a component of M w below 0 counts as 0 in P. Where the patches do not fix Q
/// (fewer than three independent colours), Q is the minimiser nearest to the identity. Where Q's condition number is
/// above `largestCondition` (a target light near one wavelength makes Q nearly rank one), Q's small singular values are
/// raised to the largest over that number before it is inverted for N. Skins that count nothing change nothing.
/// @throws spectral::InputError: a dead or collinear primary, a dead chart channel, an environment without light,
///         a black level above the wall's signal, no patches, a held patch without light, charts, names or weights that
///         are not as many as the target's patches, an option out of its range
WallSolution solveWall(const WallCapture& capture, const WallOptions& options = {});

/// The inverse of Q with Q's singular values raised to the largest over `limit`; Q's own inverse where none is smaller.
/// @param limit  1 or more, or infinite
Eigen::Matrix3d boundedInverse(const Eigen::Matrix3d& correctedFromCamera, double limit);

}  // namespace metamer::stage
