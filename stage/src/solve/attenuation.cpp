// SPDX-License-Identifier: Apache-2.0
#include "solve/attenuation.h"

#include <Eigen/Dense>

namespace metamer::stage {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

/// Of a direction of P no more is taken for noise.
constexpr double kMostNoise = 0.9;

/// (B' (P Pᵀ) B) (B' (P Pᵀ - V) B)^-1 for columns B.
template <typename Basis>
Eigen::MatrixXd gainIn(const Basis& basis, const Matrix3d& square, const Vector3d& variance) {
  const Eigen::MatrixXd whole = basis.transpose() * square * basis;
  Eigen::MatrixXd noise = basis.transpose() * variance.asDiagonal() * basis;
  const Eigen::MatrixXd root = whole.llt().matrixL();
  const Eigen::MatrixXd half = root.triangularView<Eigen::Lower>().solve(noise);
  const Eigen::MatrixXd share = root.triangularView<Eigen::Lower>().solve(half.transpose());
  const double largest = Eigen::JacobiSVD<Eigen::MatrixXd>(share).singularValues()[0];
  if (!(largest < kMostNoise)) {
    noise *= kMostNoise / largest;
  }
  return (whole - noise).ldlt().solve(whole).transpose();
}

}  // namespace

Matrix3d withoutAttenuation(const WallCapture& capture, const WallOptions& walls, const WallSolution& solution,
                            const CaptureNoise& noise, double times) {
  if (solution.chartRank < 3) {
    return solution.correctedFromCamera;
  }
  const Eigen::VectorXd weights =
      walls.patchWeights.size() != 0 ? walls.patchWeights : Eigen::VectorXd::Ones(capture.target.cols()).eval();
  Matrix3d square = solution.predicted * weights.asDiagonal() * solution.predicted.transpose();
  if (walls.skins && walls.skinWeight > 0) {
    square += walls.skinWeight * solution.predictedSkins * solution.predictedSkins.transpose();
  }
  Vector3d variance = Vector3d::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const double factor = capture.beta * solution.environmentDrive[static_cast<Eigen::Index>(k)];
    const Matrix3Xd squares = (noise.relative * capture.charts[k]).array().square() + noise.floor * noise.floor;
    variance += factor * factor * squares * weights;
  }
  variance *= times;
  const Matrix3d& q = solution.correctedFromCamera;
  if (variance.isZero(0)) {
    return q;
  }
  if (walls.heldPatch < 0) {
    return q * gainIn(Matrix3d::Identity(), square, variance);
  }
  // What Q does along the held patch is given.
  const Vector3d along = solution.predicted.col(walls.heldPatch).normalized();
  const Eigen::HouseholderQR<Vector3d> factors(along);
  const Eigen::Matrix<double, 3, 2> across = (factors.householderQ() * Matrix3d::Identity()).rightCols<2>();
  return q * along * along.transpose() + q * across * gainIn(across, square, variance) * across.transpose();
}

}  // namespace metamer::stage
