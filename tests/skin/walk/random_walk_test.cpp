// SPDX-License-Identifier: Apache-2.0
#include "metamer/skin/random_walk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "metamer/skin/skin_model.h"
#include "spectral/fixture.h"

namespace metamer::skin {
namespace {

using spectral::testLibrary;
using spectral::unitRandom;

bool isLong() {
  const char* const value = std::getenv("METAMER_LONG");
  return value != nullptr && std::string_view(value) == "1";
}

/// Corners of table 3.2 at a few wavelengths, then draws over its ranges: 40 points.
std::vector<LayerOptics> judgedPoints() {
  std::vector<LayerOptics> points;
  for (int corner = 0; corner < 8; ++corner) {
    const SkinParameters skin{(corner & 1) != 0 ? 1 : 0.001, (corner & 2) != 0 ? 1 : 0.001,
                              (corner & 4) != 0 ? 350.0 : 10.0, 0.5, 0.3};
    const SkinModel model(testLibrary(), {380, 580, 780});
    for (const LayerOptics& one : model.layers(skin)) {
      points.push_back(one);
    }
  }
  std::mt19937 random(11);
  while (points.size() < 40) {
    SkinCoordinates at;
    for (Eigen::Index i = 0; i < 5; ++i) {
      at[i] = lowestCoordinates()[i] + (highestCoordinates()[i] - lowestCoordinates()[i]) * unitRandom(random);
    }
    const SkinModel model(testLibrary(), {380 + 400 * unitRandom(random)});
    points.push_back(model.layers(skinOf(at)).front());
  }
  return points;
}

TEST(RandomWalk, JudgesAddingDoubling) {
  const std::vector<LayerOptics> points = judgedPoints();
  const std::int64_t trial = isLong() ? 200'000 : 3'000;
  // Long: as many paths as bring the walk's standard error to 2e-4.
  constexpr double kWanted = 1.9e-4;
  double worst = 0;
  double worstError = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    WalkedAlbedo walked = walkedAlbedo(points[i], WalkSpace::Three, trial, 100 + i);
    if (isLong() && walked.standardError > kWanted) {
      const double more = std::pow(walked.standardError / kWanted, 2);
      walked = walkedAlbedo(points[i], WalkSpace::Three,
                            static_cast<std::int64_t>(more * 1.05 * static_cast<double>(trial)), 200 + i);
    }
    const double difference = std::abs(walked.albedo - layeredAlbedo(points[i]));
    // Four standard errors of a short walk beside what adding-doubling may err by.
    const double allowed = isLong() ? 1.5e-3 : 1.5e-3 + 4 * walked.standardError;
    EXPECT_LE(difference, allowed) << i << ": walked " << walked.albedo << " +- " << walked.standardError;
    worst = std::max(worst, difference);
    worstError = std::max(worstError, walked.standardError);
  }
  std::printf("[ adding-doubling against the walk ] worst %.2g over %zu points, standard error up to %.2g\n", worst,
              points.size(), worstError);
  if (isLong()) {
    EXPECT_LE(worstError, 2e-4);
  }
}

TEST(RandomWalk, InFlatlandIsALittleBrighter) {
  // 0 to 8 % by trial (section 3.4 walks in the plane).
  const SkinModel model(testLibrary(), {500, 560, 650});
  for (const LayerOptics& layers : model.layers({0.008, 0.02, 100, 0.7, 0.25})) {
    const WalkedAlbedo walked = walkedAlbedo(layers, WalkSpace::Two, 20'000, 5);
    const double more = walked.albedo / layeredAlbedo(layers) - 1;
    EXPECT_GT(more, -4 * walked.standardError);
    EXPECT_LT(more, 0.08 + 4 * walked.standardError);
  }
}

TEST(RandomWalk, IsTheSameForASeed) {
  const LayerOptics layers = judgedPoints().back();
  const double once = walkedAlbedo(layers, WalkSpace::Three, 500, 3).albedo;
  EXPECT_EQ(once, walkedAlbedo(layers, WalkSpace::Three, 500, 3).albedo);
  EXPECT_NE(once, walkedAlbedo(layers, WalkSpace::Three, 500, 4).albedo);
}

}  // namespace
}  // namespace metamer::skin
