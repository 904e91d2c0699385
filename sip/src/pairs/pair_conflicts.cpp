// SPDX-License-Identifier: Apache-2.0
#include "pairs/pair_conflicts.h"

#include <algorithm>
#include <cmath>

namespace metamer::sip {

namespace {

using Eigen::Index;

/// Of deviations: below, two are the same to the eye under any light, wherever they lie.
constexpr double kSame = 1e-6;
/// How steep what softened pairs mix to may be.
constexpr double kSoftSlope = 1.0;
/// Conflicts of one pair that are settled together, the nearest.
constexpr std::size_t kMostTogether = 48;
constexpr int kMostSteps = 400;
/// Steps towards the origin end when they gain no more than this part.
constexpr double kLeastGain = 1e-9;
/// Bands that differences are judged on.
constexpr Index kJudgedBands = 41;

/// What is seen of the spectrum, over 380 ... 780 nm: whole from 430 to 660 nm, nothing beyond 400 and 700.
double seen(double share) {
  const double nm = 380.0 + 400.0 * share;
  return std::clamp(std::min((nm - 400.0) / 30.0, (700.0 - nm) / 40.0), 0.0, 1.0);
}

/// Deviations as the eye counts them: the length of a column is the root mean square.
Eigen::MatrixXd judged(const Eigen::MatrixXd& deviations) {
  const Index bands = deviations.rows();
  const Index count = std::min(bands, kJudgedBands);
  Eigen::MatrixXd some(count, deviations.cols());
  double total = 0.0;
  for (Index k = 0; k < count; ++k) {
    const Index band = k * (bands - 1) / (count - 1);
    const double weight = seen(static_cast<double>(band) / static_cast<double>(bands - 1));
    total += weight;
    some.row(k) = std::sqrt(weight) * deviations.row(band);
  }
  return some / std::sqrt(total);
}

/// Weights, none below zero and 1 in all, of the mixture of columns that is nearest to the origin.
Eigen::VectorXd nearestToOrigin(const Eigen::MatrixXd& columns) {
  const Eigen::MatrixXd products = columns.transpose() * columns;
  const Index count = columns.cols();
  Index nearest = 0;
  products.diagonal().minCoeff(&nearest);
  Eigen::VectorXd weights = Eigen::VectorXd::Unit(count, nearest);
  Eigen::VectorXd gradient = products.col(nearest);
  for (int step = 0; step < kMostSteps; ++step) {
    // Weight moves from the column that lies farthest along the mixture to the one that lies least.
    Index least = 0;
    gradient.minCoeff(&least);
    Index most = least;
    for (Index i = 0; i < count; ++i) {
      if (weights[i] > 0.0 && gradient[i] > gradient[most]) {
        most = i;
      }
    }
    const double gain = gradient[most] - gradient[least];
    const double curvature = products(most, most) + products(least, least) - 2.0 * products(most, least);
    if (!(gain > kLeastGain * products.diagonal().maxCoeff()) || !(curvature > 0.0)) {
      break;
    }
    const double moved = std::min(weights[most], gain / curvature);
    weights[most] -= moved;
    weights[least] += moved;
    gradient += moved * (products.col(least) - products.col(most));
  }
  return weights;
}

/// What a mixture is worth: all where the columns are alike, nothing where one is farther from it than it is long.
double agreement(const Eigen::MatrixXd& columns, const Eigen::VectorXd& mixture) {
  const double spread = (columns.colwise() - mixture).colwise().squaredNorm().maxCoeff();
  const double size = mixture.squaredNorm();
  return size > spread ? 1.0 - spread / size : 0.0;
}

bool isSteep(double difference, double distance) {
  return difference > kSteepestPairs * distance + kSame;
}

/// Calls with all i < j that are steep between them, and their distance.
template <typename Body>
void forSteep(const Eigen::Matrix2Xd& places, const Eigen::MatrixXd& columns, Body body) {
  const Eigen::VectorXd lengths = columns.colwise().norm().transpose();
  for (Index j = 1; j < places.cols(); ++j) {
    for (Index i = 0; i < j; ++i) {
      const double most = (lengths[i] + lengths[j] - kSame) / kSteepestPairs;
      const double squared = (places.col(i) - places.col(j)).squaredNorm();
      if (most <= 0.0 || squared >= most * most) {
        continue;
      }
      const double difference = (columns.col(i) - columns.col(j)).norm();
      const double distance = std::sqrt(squared);
      if (isSteep(difference, distance)) {
        body(i, j, difference, distance);
      }
    }
  }
}

}  // namespace

SettledPairs settledPairs(const Eigen::Matrix2Xd& places, const Eigen::MatrixXd& deviations) {
  const Index count = places.cols();
  const Index white = count - 1;
  SettledPairs settled{deviations, Eigen::VectorXd::Zero(count), {}};
  settled.conflicts.resize(static_cast<std::size_t>(count));
  const auto conflictsOf = [&](Index i) -> std::vector<Index>& {
    return settled.conflicts[static_cast<std::size_t>(i)];
  };
  const Eigen::MatrixXd columns = judged(deviations);
  forSteep(places, columns, [&](Index i, Index j, double, double) {
    conflictsOf(i).push_back(j);
    conflictsOf(j).push_back(i);
  });
  for (Index i = 0; i < white; ++i) {
    std::vector<Index>& others = conflictsOf(i);
    if (others.empty()) {
      continue;
    }
    std::stable_sort(others.begin(), others.end(), [&](Index a, Index b) {
      return (places.col(a) - places.col(i)).squaredNorm() < (places.col(b) - places.col(i)).squaredNorm();
    });
    std::vector<Index> together(others.begin(),
                                others.begin() + static_cast<std::ptrdiff_t>(std::min(others.size(), kMostTogether)));
    together.push_back(i);
    const Eigen::MatrixXd asked = columns(Eigen::all, together);
    const Eigen::VectorXd weights = nearestToOrigin(asked);
    settled.deviations.col(i) = agreement(asked, asked * weights) * (deviations(Eigen::all, together) * weights);
  }
  forSteep(places, judged(settled.deviations), [&](Index i, Index j, double difference, double distance) {
    for (const Index k : {i, j}) {
      if (k != white && !conflictsOf(k).empty()) {
        settled.softness[k] = std::max(settled.softness[k], difference / kSoftSlope - distance);
      }
    }
  });
  return settled;
}

}  // namespace metamer::sip
