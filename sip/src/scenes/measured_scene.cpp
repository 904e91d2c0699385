// SPDX-License-Identifier: Apache-2.0
#include "scenes/measured_scene.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

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
/// A colour whose mean is this small a part of its largest channel lies so far from all samples that the kernel is
/// zero.
constexpr double kLeastMean = 1e-4;

constexpr double kInverseReach = std::numbers::sqrt3 / MeasuredScene::kReach;

/// Distances of a place to others, times kInverseReach.
Eigen::ArrayXd distances(const Eigen::ArrayX2d& places, const Eigen::Vector2d& place) {
  return kInverseReach * ((places.col(0) - place.x()).square() + (places.col(1) - place.y()).square()).sqrt();
}

bool isNearSamples(const Eigen::Vector3d& response) {
  return response.mean() > kLeastMean * response.cwiseAbs().maxCoeff();
}

/// The channels in order of their weights' centroids: the middle one second.
std::array<Index, 3> alongSpectrum(const Eigen::Matrix3Xd& weights) {
  const Eigen::VectorXd bands = Eigen::VectorXd::LinSpaced(weights.cols(), 0.0, 1.0);
  const Eigen::Vector3d centroids = (weights * bands).cwiseQuotient(weights.rowwise().sum());
  std::array<Index, 3> order = {0, 1, 2};
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return centroids[a] > centroids[b]; });
  return order;
}

}  // namespace

MeasuredScene::MeasuredScene(const SoftBoundSolver& solver, const Eigen::MatrixXd& reflectances,
                             const Eigen::VectorXd& noise) {
  const Eigen::Matrix3Xd& weights = solver.weights();
  const auto [first, middle, last] = alongSpectrum(weights);
  m_differences.setZero();
  m_differences(0, first) = 1.0;
  m_differences(1, last) = 1.0;
  m_differences.col(middle).setConstant(-1.0);

  const Index bandCount = weights.cols();
  m_nodes.resize(bandCount);
  m_fractions.resize(bandCount);
  Eigen::MatrixXd nodeWeights = Eigen::MatrixXd::Zero(3, kNodeCount);
  for (Index b = 0; b < bandCount; ++b) {
    const double position = static_cast<double>((kNodeCount - 1) * b) / static_cast<double>(bandCount - 1);
    m_nodes[b] = std::min(static_cast<int>(position), kNodeCount - 2);
    m_fractions[b] = position - m_nodes[b];
    nodeWeights.col(m_nodes[b]) += (1.0 - m_fractions[b]) * weights.col(b);
    nodeWeights.col(m_nodes[b] + 1) += m_fractions[b] * weights.col(b);
  }
  // Samples are kept less smooth spectra at the nodes, so that sums lose no digits; what these differ by from the
  // smooth spectra at the bands is made up for.
  Eigen::MatrixX3d nodeSmooth(kNodeCount, 3);
  for (Index j = 0; j < kNodeCount; ++j) {
    const double position = static_cast<double>((bandCount - 1) * j) / (kNodeCount - 1);
    const Index band = std::min(static_cast<Index>(position), bandCount - 2);
    const double fraction = position - static_cast<double>(band);
    nodeSmooth.row(j) = (1.0 - fraction) * solver.unclamped().row(band) + fraction * solver.unclamped().row(band + 1);
  }
  m_smooth.resize(bandCount, 3);
  for (Index b = 0; b < bandCount; ++b) {
    m_smooth.row(b) = solver.unclamped().row(b) - (1.0 - m_fractions[b]) * nodeSmooth.row(m_nodes[b]) -
                      m_fractions[b] * nodeSmooth.row(m_nodes[b] + 1);
  }
  const Eigen::Matrix3Xd all = nodeWeights * reflectances;
  std::vector<Index> used;
  for (Index i = 0; i < all.cols(); ++i) {
    if (all.col(i).mean() >= kDarkest) {
      used.push_back(i);
    }
  }
  const Eigen::Matrix3Xd responses = all(Eigen::all, used);
  const Eigen::RowVectorXd means = responses.colwise().mean();
  const Index count = responses.cols();

  Eigen::Matrix2Xd places = (m_differences * responses).array().rowwise() / means.array();
  const Eigen::Vector2d centre = places.rowwise().mean();
  const Eigen::Matrix2Xd centred = places.colwise() - centre;
  const Eigen::Matrix2d covariance = centred * centred.transpose() / std::max<double>(1.0, static_cast<double>(count));
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(covariance);
  const Eigen::Matrix2d whitening =
      axes.eigenvectors() * axes.eigenvalues().cwiseMax(kLeastVariance).cwiseSqrt().cwiseInverse().asDiagonal() *
      axes.eigenvectors().transpose();
  m_differences = whitening * m_differences;
  // The perfect reflector comes last: no difference between its channels, and no deviation.
  m_places.resize(count + 1, 2);
  m_places.topRows(count) = (whitening * places).transpose().array();
  m_places.row(count).setZero();

  // Spectra for a mean of one, and their responses: the solver's bands and smooth spectra come in when they are summed.
  // The perfect reflector deviates by nothing, and so may stand as nothing.
  Eigen::MatrixXd targets = Eigen::MatrixXd::Zero(count + 1, kNodeCount + 3);
  targets.topLeftCorner(count, kNodeCount) =
      ((reflectances(Eigen::all, used) - nodeSmooth * responses).array().rowwise() / means.array())
          .matrix()
          .transpose();
  targets.topRightCorner(count, 3) = (responses.array().rowwise() / means.array()).matrix().transpose();
  Eigen::MatrixXd kernel(count + 1, count + 1);
  for (Index i = 0; i <= count; ++i) {
    const Eigen::ArrayXd t = distances(m_places, m_places.row(i).transpose());
    kernel.col(i) = ((1.0 + t) * (-t).exp()).matrix();
    if (i < count) {
      const double dark = kDarkNoise / means[i];
      kernel(i, i) += noise[used[static_cast<std::size_t>(i)]] * (1.0 + dark * dark);
    }
  }
  m_coefficients = WeightedSums(Eigen::LLT<Eigen::MatrixXd>(kernel).solve(targets).transpose());
}

MeasuredScene::Chromaticity MeasuredScene::chromaticityOf(const Eigen::Vector3d& response) const {
  const double mean = response.mean();
  const Eigen::Vector2d place = m_differences * response / mean;
  return {mean, place, m_differences / mean - place * Eigen::RowVector3d::Constant(1.0 / (3.0 * mean))};
}

BandVector MeasuredScene::atBands(const Eigen::VectorXd& sums) const {
  BandVector spectrum = -(m_smooth * sums.tail<3>());
  for (Index b = 0; b < spectrum.size(); ++b) {
    const double* node = sums.data() + m_nodes[b];
    spectrum[b] += (1.0 - m_fractions[b]) * node[0] + m_fractions[b] * node[1];
  }
  return spectrum;
}

BandVector MeasuredScene::deviation(const Eigen::Vector3d& response) const {
  if (!isNearSamples(response)) {
    return BandVector::Zero(m_nodes.size());
  }
  const Chromaticity colour = chromaticityOf(response);
  const Eigen::ArrayXd t = distances(m_places, colour.place);
  return atBands(m_coefficients.of(colour.mean * (1.0 + t) * (-t).exp()));
}

MeasuredScene::Local MeasuredScene::local(const Eigen::Vector3d& response) const {
  const Index bandCount = m_nodes.size();
  if (!isNearSamples(response)) {
    return {BandVector::Zero(bandCount), BandTriple::Zero(bandCount, 3)};
  }
  const Chromaticity colour = chromaticityOf(response);
  const Eigen::ArrayXd t = distances(m_places, colour.place);
  const Eigen::ArrayXd fade = (-t).exp();
  // The kernel, and its slopes by the chromaticity.
  Eigen::ArrayXXd kernel(t.size(), 3);
  kernel.col(0) = (1.0 + t) * fade;
  for (Index k = 0; k < 2; ++k) {
    kernel.col(1 + k) = kInverseReach * kInverseReach * (m_places.col(k) - colour.place[k]) * fade;
  }
  const Eigen::MatrixXd sums = m_coefficients.of(kernel);
  BandTriple spectra(bandCount, 3);
  for (Index k = 0; k < 3; ++k) {
    spectra.col(k) = atBands(sums.col(k));
  }
  return {colour.mean * spectra.col(0), spectra.col(0) * Eigen::RowVector3d::Constant(1.0 / 3.0) +
                                            colour.mean * (spectra.rightCols<2>() * colour.slope)};
}

}  // namespace metamer::sip
