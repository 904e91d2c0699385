// SPDX-License-Identifier: Apache-2.0
#include "scenes/leading_places.h"

#include <algorithm>
#include <cmath>

#include "scenes/sample_kernel.h"

namespace metamer::sip {

using Eigen::Index;

namespace {

/// Of the kernel's 1: of a place of which no more than this is unsaid, nothing is left but rounding.
constexpr double kNothingLeft = 1e-10;

}  // namespace

LeadingPlaces::LeadingPlaces(const Eigen::ArrayX2d& places, Index first, Index most) {
  const Index count = places.rows();
  const Index limit = std::min(count, std::max(first, most));
  const SampleKernel kernel(places);
  features = Eigen::MatrixXd::Zero(count, limit);
  Eigen::VectorXd unsaid = Eigen::VectorXd::Ones(count);
  const auto choose = [&](Index place) {
    const auto rank = static_cast<Index>(chosen.size());
    Eigen::VectorXd column = kernel.values(places.row(place).transpose()).head(count);
    column.noalias() -= features.leftCols(rank) * features.row(place).head(rank).transpose();
    features.col(rank) = column / std::sqrt(column[place]);
    for (const Index before : chosen) {
      features(before, rank) = 0.0;
    }
    unsaid -= features.col(rank).cwiseAbs2();
    unsaid[place] = 0.0;
    chosen.push_back(place);
  };
  for (Index place = 0; place < first; ++place) {
    if (unsaid[place] > kNothingLeft) {
      choose(place);
    }
  }
  while (static_cast<Index>(chosen.size()) < limit) {
    Index next = 0;
    if (!(unsaid.maxCoeff(&next) > kNothingLeft)) {
      break;
    }
    choose(next);
  }
  features.conservativeResize(Eigen::NoChange, static_cast<Index>(chosen.size()));
}

}  // namespace metamer::sip
