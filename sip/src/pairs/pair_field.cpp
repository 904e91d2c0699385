// SPDX-License-Identifier: Apache-2.0
#include "pairs/pair_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pairs/pair_conflicts.h"
#include "response/chromaticity.h"

namespace metamer::sip {

namespace {

using Eigen::Index;
using Eigen::Vector2d;

/// Up to this distance, in standard deviations, weights fall with its square, beyond with itself. By cross-validation
/// on charts.
constexpr double kHalf = 0.5;
/// A pair reaches as far as so many others lie, so that many pairs make detail and not a mean of all.
constexpr Index kNeighbours = 32;
/// This near to a pair, squared, a colour has its chromaticity.
constexpr double kSamePlace = 1e-20;
/// Of the radius.
constexpr double kLeastReach = 1e-3;
/// How far the cover of some pairs reaches beside the pairs.
constexpr double kCoverShare = 0.25;

/// Where the places that are farther than most neighbours begin; infinite where there are too few.
double reachOf(const Eigen::Matrix2Xd& places, Index at) {
  if (places.cols() <= kNeighbours + 1) {
    return std::numeric_limits<double>::infinity();
  }
  Eigen::VectorXd distances = (places.colwise() - places.col(at)).colwise().norm().transpose();
  std::nth_element(distances.begin(), distances.begin() + kNeighbours, distances.end());
  return distances[kNeighbours];
}

}  // namespace

PairField::PairField(const Eigen::Matrix<double, 2, 3>& differences, const Eigen::Matrix3Xd& responses,
                     const Eigen::MatrixXd& deviations, double radius)
    : m_differences(differences), m_at(static_cast<std::size_t>(responses.cols()), -1) {
  for (Index i = 0; i < responses.cols(); ++i) {
    if (responses.col(i).mean() >= kDarkestMean) {
      m_at[static_cast<std::size_t>(i)] = static_cast<Index>(m_pair.size());
      m_pair.push_back(i);
    }
  }
  const auto count = static_cast<Index>(m_pair.size());
  m_places = Eigen::Matrix2Xd::Zero(2, count + 1);
  Eigen::MatrixXd own = Eigen::MatrixXd::Zero(deviations.rows(), count + 1);
  for (Index k = 0; k < count; ++k) {
    const Index pair = m_pair[static_cast<std::size_t>(k)];
    m_places.col(k) = placeOf(responses.col(pair));
    own.col(k) = deviations.col(pair) / responses.col(pair).mean();
  }
  m_pair.push_back(kWhite);
  SettledPairs settled = settledPairs(m_places, own);
  m_deviations = std::move(settled.deviations);
  m_softness = std::move(settled.softness);
  m_conflicts = std::move(settled.conflicts);
  m_reaches.resize(count + 1);
  for (Index k = 0; k <= count; ++k) {
    // Many pairs at one place reach a little farther than nowhere.
    m_reaches[k] = std::max(reachOf(m_places, k), kLeastReach * radius);
  }
  m_cover = Cover(m_places.leftCols(count), m_reaches.head(count).cwiseMin(radius));
  // Softened distances end where plain ones do, so that there is a weight wherever there is a cover.
  m_reaches = (m_reaches.array().square() + m_softness.array().square()).sqrt();
}

std::vector<Index> PairField::conflictsOf(Index pair) const {
  std::vector<Index> pairs;
  if (!isDark(pair)) {
    for (const Index place : m_conflicts[static_cast<std::size_t>(m_at[static_cast<std::size_t>(pair)])]) {
      pairs.push_back(m_pair[static_cast<std::size_t>(place)]);
    }
  }
  return pairs;
}

Cover PairField::coverOf(const std::vector<Index>& pairs) const {
  std::vector<Index> at;
  for (const Index pair : pairs) {
    at.push_back(m_at[static_cast<std::size_t>(pair)]);
  }
  return Cover(m_places(Eigen::all, at), kCoverShare * m_cover.radii()(at));
}

Eigen::Matrix<double, 2, 3> PairField::placeSlope(const Eigen::Vector3d& response) const {
  return sip::placeSlope(m_differences, placeOf(response), response.mean());
}

Eigen::MatrixXd PairField::valueAt(const Vector2d& place, bool withSlopes) const {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(m_deviations.rows(), withSlopes ? 3 : 1);
  const Cover::Share share = m_cover.at(place);
  if (share.value == 0.0) {
    return result;
  }
  double total = 0.0;
  Vector2d totalSlope = Vector2d::Zero();
  for (Index k = 0; k < m_places.cols(); ++k) {
    const Vector2d away = place - m_places.col(k);
    const double squared = away.squaredNorm() + m_softness[k] * m_softness[k];
    if (squared < kSamePlace) {
      result.setZero();
      result.col(0) = share.value * m_deviations.col(k);
      if (withSlopes) {
        result.rightCols<2>() = m_deviations.col(k) * share.slope.transpose();
      }
      return result;
    }
    const double x = std::sqrt(squared);
    const double end = 1.0 - x / m_reaches[k];
    if (end <= 0.0) {
      continue;
    }
    const double near = 1.0 / squared + 1.0 / (kHalf * x);
    const double weight = near * end * end;
    total += weight;
    result.col(0) += weight * m_deviations.col(k);
    if (withSlopes) {
      const double byX = -(2.0 / x + 1.0 / kHalf) / squared * end * end - 2.0 * near * end / m_reaches[k];
      const Vector2d slope = byX / x * away;
      totalSlope += slope;
      result.rightCols<2>() += m_deviations.col(k) * slope.transpose();
    }
  }
  result /= total;
  if (withSlopes) {
    const Eigen::VectorXd mean = result.col(0);
    result.rightCols<2>() = share.value * (result.rightCols<2>() - mean * (totalSlope / total).transpose()) +
                            mean * share.slope.transpose();
  }
  result.col(0) *= share.value;
  return result;
}

void PairField::addTo(Eigen::MatrixXd& deviations, const Eigen::Matrix3Xd& responses) const {
  for (Index k = 0; k < responses.cols(); ++k) {
    if (hasChromaticity(responses.col(k))) {
      deviations.col(k) += responses.col(k).mean() * valueAt(placeOf(responses.col(k)), false);
    }
  }
}

void PairField::addTo(BandTriple& slope, const Eigen::Vector3d& response) const {
  if (hasChromaticity(response)) {
    const Eigen::MatrixXd value = valueAt(placeOf(response), true);
    slope += value.col(0) * Eigen::RowVector3d::Constant(1.0 / 3.0) +
             response.mean() * value.rightCols<2>() * placeSlope(response);
  }
}

}  // namespace metamer::sip
