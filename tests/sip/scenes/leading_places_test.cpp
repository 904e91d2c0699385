// SPDX-License-Identifier: Apache-2.0
#include "scenes/leading_places.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "scenes/sample_kernel.h"

namespace metamer::sip {
namespace {

using Eigen::Index;

Eigen::ArrayX2d scattered(Index count) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  Eigen::ArrayX2d places(count, 2);
  for (Index i = 0; i < count; ++i) {
    places.row(i) << normal(random), normal(random);
  }
  return places;
}

Eigen::MatrixXd kernelOf(const Eigen::ArrayX2d& places) {
  const SampleKernel kernel(places);
  Eigen::MatrixXd all(places.rows(), places.rows());
  for (Index i = 0; i < places.rows(); ++i) {
    all.col(i) = kernel.values(places.row(i).transpose()).head(places.rows());
  }
  return all;
}

/// Largest part of a place's kernel that the features do not have.
double unsaid(const LeadingPlaces& leading, const Eigen::MatrixXd& kernel) {
  return (kernel - leading.features * leading.features.transpose()).diagonal().maxCoeff();
}

TEST(LeadingPlacesTest, AllOfThemSayAll) {
  const Eigen::ArrayX2d places = scattered(60);
  const LeadingPlaces leading(places, 1, 60);
  EXPECT_EQ(std::set<Index>(leading.chosen.begin(), leading.chosen.end()).size(), 60U);
  const Eigen::MatrixXd kernel = kernelOf(places);
  EXPECT_LE((kernel - leading.features * leading.features.transpose()).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(LeadingPlacesTest, AFewSayNearlyAllAndTheirOwnRowsExactly) {
  const Eigen::ArrayX2d places = scattered(400);
  const Eigen::MatrixXd kernel = kernelOf(places);
  double before = 1.0;
  for (const Index most : {20, 40, 80, 160}) {
    const LeadingPlaces leading(places, 1, most);
    ASSERT_EQ(static_cast<Index>(leading.chosen.size()), most);
    const double left = unsaid(leading, kernel);
    // Of a kernel with a cusp in its third derivative in a plane: the power 3/2 of a place's share of it.
    EXPECT_LT(left, 0.5 * before) << most;
    before = left;
    const Eigen::MatrixXd said = leading.features(leading.chosen, Eigen::all) * leading.features.transpose();
    EXPECT_LE((said - kernel(leading.chosen, Eigen::all)).cwiseAbs().maxCoeff(), 1e-13) << most;
    for (Index i = 0; i < most; ++i) {
      EXPECT_TRUE(leading.features.row(leading.chosen[static_cast<std::size_t>(i)]).tail(most - 1 - i).isZero(0.0));
    }
  }
  EXPECT_LT(before, 0.004);
}

TEST(LeadingPlacesTest, FirstOnesGoFirstHoweverManyAndTwinsOnce) {
  Eigen::ArrayX2d places = scattered(30);
  places.row(2) = places.row(1);
  places.row(20) = places.row(25);
  const LeadingPlaces leading(places, 5, 3);
  ASSERT_EQ(leading.chosen.size(), 5U);
  EXPECT_EQ(std::vector<Index>(leading.chosen.begin(), leading.chosen.begin() + 4), (std::vector<Index>{0, 1, 3, 4}));
  const LeadingPlaces all(places, 5, 30);
  EXPECT_EQ(all.chosen.size(), 28U);
  EXPECT_LE(unsaid(all, kernelOf(places)), 1e-9);
  EXPECT_TRUE(all.features.allFinite());
}

}  // namespace
}  // namespace metamer::sip
