// SPDX-License-Identifier: Apache-2.0
#include "scenes/measured_seeds.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <numbers>
#include <vector>

#include "response/chromaticity.h"
#include "scenes/leading_places.h"
#include "scenes/node_bands.h"

namespace metamer::sip {

namespace {

using Eigen::Index;

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

/// How much of each feature the targets take: the first samples' features so that they are met, the others' so that
/// what remains is met as nearly as its noise says.
/// @param exact      samples that are met; the first
/// @param precision  of the others: 1 / noise
Eigen::MatrixXd featuresTaken(const LeadingPlaces& leading, Index exact, const Eigen::MatrixXd& targets,
                              const Eigen::VectorXd& precision) {
  const auto count = static_cast<Index>(leading.chosen.size());
  const auto met = static_cast<Index>(
      std::count_if(leading.chosen.begin(), leading.chosen.end(), [&](Index sample) { return sample < exact; }));
  const std::vector<Index> first(leading.chosen.begin(), leading.chosen.begin() + met);
  Eigen::MatrixXd taken(count, targets.cols());
  taken.topRows(met) = leading.features(first, Eigen::seqN(0, met))
                           .eval()
                           .triangularView<Eigen::Lower>()
                           .solve(targets(first, Eigen::all).eval());
  const Index others = precision.size();
  const Eigen::MatrixXd rest =
      targets.bottomRows(others) - leading.features.bottomLeftCorner(others, met) * taken.topRows(met);
  const Eigen::MatrixXd weighted =
      precision.cwiseSqrt().asDiagonal() * leading.features.bottomRightCorner(others, count - met);
  Eigen::MatrixXd system = Eigen::MatrixXd::Identity(count - met, count - met);
  system.selfadjointView<Eigen::Lower>().rankUpdate(weighted.transpose());
  taken.bottomRows(count - met) = system.selfadjointView<Eigen::Lower>().llt().solve(
      weighted.transpose() * (precision.cwiseSqrt().asDiagonal() * rest));
  return taken;
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
  // What is to be met exactly comes first, behind the perfect reflector.
  std::vector<Index> used;
  Index exact = 1;
  for (const bool isExact : {true, false}) {
    for (Index i = 0; i < all.cols(); ++i) {
      if ((noise[i] == 0.0) == isExact && all.col(i).mean() >= kDarkestMean) {
        used.push_back(i);
      }
    }
    if (isExact) {
      exact += static_cast<Index>(used.size());
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
  // The perfect reflector: no difference between its channels, and no deviation, so that it may stand as nothing.
  Eigen::ArrayX2d samples(count + 1, 2);
  samples.row(0).setZero();
  samples.bottomRows(count) = kInverseReach * (whitening * unscaled).transpose().array();
  Eigen::MatrixXd targets = Eigen::MatrixXd::Zero(count + 1, kNodeCount + 3);
  targets.bottomLeftCorner(count, kNodeCount) =
      (reflectances(Eigen::all, used).array().rowwise() / means.array()).matrix().transpose();
  targets.bottomRightCorner(count, 3) = (responses.array().rowwise() / means.array()).matrix().transpose();
  Eigen::VectorXd precision(count + 1 - exact);
  for (Index i = 0; i < precision.size(); ++i) {
    const Index sample = exact - 1 + i;
    const double dark = kDarkNoise / means[sample];
    precision[i] = 1.0 / (noise[used[static_cast<std::size_t>(sample)]] * (1.0 + dark * dark));
  }

  const LeadingPlaces leading(samples, exact, kMostSeeds);
  places = samples(leading.chosen, Eigen::all);
  solved = leading.features(leading.chosen, Eigen::all)
               .transpose()
               .triangularView<Eigen::Upper>()
               .solve(featuresTaken(leading, exact, targets, precision))
               .transpose();
}

}  // namespace metamer::sip
