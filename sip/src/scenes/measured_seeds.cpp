// SPDX-License-Identifier: Apache-2.0
#include "scenes/measured_seeds.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <numbers>
#include <vector>

#include "scenes/node_bands.h"
#include "scenes/sample_kernel.h"

namespace metamer::sip {

namespace {

using Eigen::Index;

/// Of white's mean response: what is darker has no chromaticity to speak of.
constexpr double kDarkest = 1e-4;
/// Least variance of the samples' chromaticities in any direction, so that a lamp that hardly tells two channels apart
/// does not stretch its noise into a scale.
constexpr double kLeastVariance = 1e-4;
/// A sample with this mean response counts as twice as noisy: what is measured of the dark is mostly error.
constexpr double kDarkNoise = 0.05;

constexpr double kInverseReach = std::numbers::sqrt3 / MeasuredSeeds::kReach;

/// The channels in order of their weights' centroids: the middle one second.
std::array<Index, 3> alongSpectrum(const Eigen::Matrix3Xd& weights) {
  const Eigen::VectorXd bands = Eigen::VectorXd::LinSpaced(weights.cols(), 0.0, 1.0);
  const Eigen::Vector3d centroids = (weights * bands).cwiseQuotient(weights.rowwise().sum());
  std::array<Index, 3> order = {0, 1, 2};
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return centroids[a] > centroids[b]; });
  return order;
}

}  // namespace

MeasuredSeeds::MeasuredSeeds(const Eigen::Matrix3Xd& weights, const Eigen::MatrixXd& reflectances,
                             const Eigen::VectorXd& noise) {
  const auto [first, middle, last] = alongSpectrum(weights);
  differences.setZero();
  differences(0, first) = 1.0;
  differences(1, last) = 1.0;
  differences.col(middle).setConstant(-1.0);

  const Eigen::Matrix3Xd all = NodeBands(kNodeCount, weights.cols()).nodeWeights(weights) * reflectances;
  std::vector<Index> used;
  for (Index i = 0; i < all.cols(); ++i) {
    if (all.col(i).mean() >= kDarkest) {
      used.push_back(i);
    }
  }
  const Eigen::Matrix3Xd responses = all(Eigen::all, used);
  const Eigen::RowVectorXd means = responses.colwise().mean();
  const Index count = responses.cols();

  const Eigen::Matrix2Xd unscaled = (differences * responses).array().rowwise() / means.array();
  const Eigen::Vector2d centre = unscaled.rowwise().mean();
  const Eigen::Matrix2Xd centred = unscaled.colwise() - centre;
  const Eigen::Matrix2d covariance = centred * centred.transpose() / std::max<double>(1.0, static_cast<double>(count));
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(covariance);
  const Eigen::Matrix2d whitening =
      axes.eigenvectors() * axes.eigenvalues().cwiseMax(kLeastVariance).cwiseSqrt().cwiseInverse().asDiagonal() *
      axes.eigenvectors().transpose();
  differences = kInverseReach * whitening * differences;
  // The perfect reflector comes last: no difference between its channels, and no deviation.
  places.resize(count + 1, 2);
  places.topRows(count) = kInverseReach * (whitening * unscaled).transpose().array();
  places.row(count).setZero();

  // The perfect reflector deviates by nothing, and so may stand as nothing.
  Eigen::MatrixXd targets = Eigen::MatrixXd::Zero(count + 1, kNodeCount + 3);
  targets.topLeftCorner(count, kNodeCount) =
      (reflectances(Eigen::all, used).array().rowwise() / means.array()).matrix().transpose();
  targets.topRightCorner(count, 3) = (responses.array().rowwise() / means.array()).matrix().transpose();
  const SampleKernel samples(places);
  Eigen::MatrixXd kernel(count + 1, count + 1);
  for (Index i = 0; i <= count; ++i) {
    kernel.col(i) = samples.values(places.row(i).transpose()).head(count + 1);
    if (i < count) {
      const double dark = kDarkNoise / means[i];
      kernel(i, i) += noise[used[static_cast<std::size_t>(i)]] * (1.0 + dark * dark);
    }
  }
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factored(kernel);
  factored.solveInPlace(targets);
  solved = targets.transpose();
}

}  // namespace metamer::sip
