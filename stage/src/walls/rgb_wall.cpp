// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/rgb_wall.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/input_error.h"

namespace metamer::stage {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using spectral::InputError;

constexpr std::array<const char*, 3> kChannels = {"red", "green", "blue"};
/// A primary this much weaker than the strongest is not lit.
constexpr double kDeadChannel = 1e-6;
/// Beyond it, the digits of a camera's values do not tell the primaries apart.
constexpr double kCollinear = 1e4;
/// Directions of a chart whose size is below this share of the largest are none.
constexpr double kSingularBelow = 1e-9;
/// From here on Q's inverse deserves a second look.
constexpr double kNotableCondition = 10;

std::string text(const Vector3d& rgb) {
  char buffer[96];
  std::snprintf(buffer, sizeof buffer, "[%.6g, %.6g, %.6g]", rgb[0], rgb[1], rgb[2]);
  return buffer;
}

double condition(const Vector3d& singularValues) {
  return singularValues[2] > 0 ? singularValues[0] / singularValues[2] : std::numeric_limits<double>::infinity();
}

void check(const WallCapture& capture, const WallOptions& options) {
  const Eigen::Index patches = capture.target.cols();
  if (patches == 0) {
    throw InputError("", "charts", "", "no patch is left to solve with; check the names and values of the charts");
  }
  for (const Matrix3Xd& chart : capture.charts) {
    spectral::requireAsMany("patches of a chart", chart.cols(), "the target has", patches);
  }
  spectral::requireAsMany("patch names", static_cast<std::int64_t>(capture.patchNames.size()), "the target's patches",
                          patches);
  spectral::requireAbove("beta", capture.beta, 0);
  spectral::requireWithin("held patch", options.heldPatch, -1, static_cast<double>(patches) - 1);
  spectral::requireWithin("largest condition", options.largestCondition, 1, std::numeric_limits<double>::infinity());
  if (options.patchWeights.size() != 0) {
    spectral::requireAsMany("patch weights", options.patchWeights.size(), "the target's patches", patches);
    spectral::requireWithin("patch weight", options.patchWeights.minCoeff(), 0, std::numeric_limits<double>::max());
  }
  spectral::requireWithin("skin weight", options.skinWeight, 0, std::numeric_limits<double>::max());
  if (options.skins) {
    for (const Matrix3Xd& chart : options.skins->charts) {
      spectral::requireAsMany("skins under a channel", chart.cols(), "the target's skins",
                              options.skins->target.cols());
    }
  }
  const double strongest = capture.cameraFromWall.cwiseAbs().maxCoeff();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3d primary = capture.cameraFromWall.col(static_cast<Eigen::Index>(k));
    if (!(primary.maxCoeff() > kDeadChannel * strongest)) {
      throw InputError("", std::string("primaries.") + kChannels[k], text(primary),
                       "is a dead channel: the camera saw no light; check the panel and the patch");
    }
    const Matrix3Xd& chart = capture.charts[k];
    if (!(chart.maxCoeff() > 0)) {
      throw InputError("", std::string("charts.") + kChannels[k], "",
                       "is a dead channel: every patch is black; check the panel and the capture");
    }
  }
  if (!(capture.target.maxCoeff() > 0)) {
    throw InputError("", "charts.target", "", "every patch is black; check the capture of the real place");
  }
  if (!(capture.environmentWhite.maxCoeff() > 0)) {
    throw InputError("", "environment.white", text(capture.environmentWhite),
                     "holds no light; give what a white patch shows in the real place");
  }
  const Vector3d wallWhite = capture.cameraFromWall.rowwise().sum();
  if ((capture.blackLevel.array() >= wallWhite.array()).any()) {
    throw InputError("", "black_level", text(capture.blackLevel),
                     "is above the signal: the wall's full white is " + text(wallWhite) +
                         "; measure the black level with the in-camera part of the wall off");
  }
  if (options.heldPatch >= 0 && !(capture.target.col(options.heldPatch).norm() > 0)) {
    throw InputError("", "q.white_patch", capture.patchNames[static_cast<std::size_t>(options.heldPatch)],
                     "is black in the target; name the white patch");
  }
}

/// P: a chart in the wall's light.
Matrix3Xd predictedOf(const WallCapture& capture, const Vector3d& drive, double beta) {
  Matrix3Xd predicted = Matrix3Xd::Zero(3, capture.target.cols());
  for (std::size_t k = 0; k < 3; ++k) {
    predicted += drive[static_cast<Eigen::Index>(k)] * capture.charts[k];
  }
  return predicted * beta;
}

/// Square roots of the weights of patches.
Eigen::VectorXd rootsOf(Eigen::Index patches, const WallOptions& options) {
  return options.patchWeights.size() != 0 ? Eigen::VectorXd(options.patchWeights.cwiseSqrt())
                                          : Eigen::VectorXd::Ones(patches);
}

/// argmin |Q P - T| with weights and one patch held; the minimiser nearest to the identity.
Matrix3d solveCorrection(const Matrix3Xd& predicted, const Matrix3Xd& target, const Eigen::VectorXd& roots,
                         const WallOptions& options) {
  Eigen::MatrixX3d rows = (predicted * roots.asDiagonal()).transpose();
  Eigen::MatrixX3d wanted = ((target - predicted) * roots.asDiagonal()).transpose();
  if (options.heldPatch < 0) {
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factors(rows);
    factors.setThreshold(kSingularBelow);
    return Matrix3d::Identity() + factors.solve(wanted).transpose();
  }
  // D = Q - 1 with D p = t - p: the part of D along p is given, the rest is free.
  const Vector3d held = predicted.col(options.heldPatch);
  const Vector3d along = held.normalized();
  const Vector3d step = (target.col(options.heldPatch) - held) / held.norm();
  Eigen::Matrix<double, 3, 2> across;
  const Eigen::HouseholderQR<Vector3d> basis(along);
  across = (basis.householderQ() * Matrix3d::Identity()).rightCols<2>();
  wanted -= (rows * along) * step.transpose();
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factors(rows * across);
  factors.setThreshold(kSingularBelow);
  const Eigen::MatrixXd rest = factors.solve(wanted);  // 2 x 3
  return Matrix3d::Identity() + step * along.transpose() + rest.transpose() * across.transpose();
}

/// Q^-1 with singular values of Q no smaller than the largest over `limit`.
Matrix3d boundedInverse(const Eigen::JacobiSVD<Matrix3d>& parts, double limit) {
  const Vector3d sizes = parts.singularValues().cwiseMax(parts.singularValues()[0] / limit);
  return parts.matrixV() * sizes.cwiseInverse().asDiagonal() * parts.matrixU().transpose();
}

}  // namespace

Matrix3d boundedInverse(const Matrix3d& correctedFromCamera, double limit) {
  const Eigen::JacobiSVD<Matrix3d> parts(correctedFromCamera, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return condition(parts.singularValues()) <= limit ? Matrix3d(correctedFromCamera.inverse())
                                                    : boundedInverse(parts, limit);
}

WallSolution solveWall(const WallCapture& capture, const WallOptions& options) {
  check(capture, options);
  WallSolution solution;
  const Eigen::JacobiSVD<Matrix3d> wall(capture.cameraFromWall);
  solution.wallCondition = condition(wall.singularValues());
  if (!(solution.wallCondition < kCollinear)) {
    throw InputError("", "primaries", text(capture.cameraFromWall.col(0)),
                     "red, green and blue are collinear to the camera (condition number above 10000); check that "
                     "each patch shows its own channel alone");
  }
  solution.wallFromContent = capture.cameraFromWall.inverse();
  solution.environmentDriveAsked = solution.wallFromContent * capture.environmentWhite;
  solution.environmentDrive = solution.environmentDriveAsked.cwiseMax(0.0);
  solution.predicted = predictedOf(capture, solution.environmentDrive, capture.beta);
  if (!(solution.predicted.norm() > 0)) {
    throw InputError("", "charts", "", "the predicted chart is black; check the charts against the environment");
  }
  if (options.heldPatch >= 0 && !(solution.predicted.col(options.heldPatch).norm() > 0)) {
    throw InputError("", "q.white_patch", capture.patchNames[static_cast<std::size_t>(options.heldPatch)],
                     "is black on the stage; check the charts under the wall's channels");
  }
  const Vector3d sizes = Eigen::JacobiSVD<Matrix3d>(solution.predicted * solution.predicted.transpose())
                             .singularValues()
                             .cwiseMax(0.0)
                             .cwiseSqrt();
  solution.chartCondition = condition(sizes);
  solution.chartRank = static_cast<int>((sizes.array() > 1e-7 * sizes[0]).count());

  const Eigen::Index patches = capture.target.cols();
  Matrix3Xd predicted = solution.predicted;
  Matrix3Xd target = capture.target;
  Eigen::VectorXd roots = rootsOf(patches, options);
  if (options.skins) {
    solution.predictedSkins = predictedOf(*options.skins, solution.environmentDrive, capture.beta);
    if (options.skinWeight > 0) {
      const Eigen::Index all = patches + solution.predictedSkins.cols();
      predicted.conservativeResize(Eigen::NoChange, all);
      target.conservativeResize(Eigen::NoChange, all);
      roots.conservativeResize(all);
      predicted.rightCols(all - patches) = solution.predictedSkins;
      target.rightCols(all - patches) = options.skins->target;
      roots.tail(all - patches).setConstant(std::sqrt(options.skinWeight));
    }
  }
  solution.correctedFromCamera = solveCorrection(predicted, target, roots, options);
  solution.corrected = solution.correctedFromCamera * solution.predicted;
  if (options.skins) {
    solution.correctedSkins = solution.correctedFromCamera * solution.predictedSkins;
  }

  const Eigen::JacobiSVD<Matrix3d> correction(solution.correctedFromCamera, Eigen::ComputeFullU | Eigen::ComputeFullV);
  solution.correctionCondition = condition(correction.singularValues());
  solution.bounded = !(solution.correctionCondition <= options.largestCondition);
  const Matrix3d cameraFromCorrected = solution.bounded ? boundedInverse(correction, options.largestCondition)
                                                        : Matrix3d(solution.correctedFromCamera.inverse());
  solution.frustumFromContent = solution.wallFromContent * cameraFromCorrected;
  solution.frustumOffset = -solution.wallFromContent * capture.blackLevel;

  if (solution.correctionCondition > kNotableCondition) {
    std::vector<double> limits(kTradeOffLimits.begin(), kTradeOffLimits.end());
    limits.push_back(options.largestCondition);
    std::sort(limits.begin(), limits.end());
    limits.erase(std::unique(limits.begin(), limits.end()), limits.end());
    for (const double limit : limits) {
      const Matrix3d inverse = boundedInverse(correction, limit);
      const Matrix3d roundTrip = solution.correctedFromCamera * inverse - Matrix3d::Identity();
      solution.tradeOffs.push_back({limit, Eigen::JacobiSVD<Matrix3d>(inverse).singularValues()[0],
                                    Eigen::JacobiSVD<Matrix3d>(roundTrip).singularValues()[0]});
    }
  }
  return solution;
}

}  // namespace metamer::stage
