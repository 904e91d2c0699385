// SPDX-License-Identifier: Apache-2.0
#include "lights/light_branches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace metamer::spectral_ref {
namespace {

constexpr std::uint32_t kLights = 20000;

/// Small lights all over a cube of side 1, each shining all around.
std::vector<LightBounds> cloud(std::mt19937& random) {
  std::uniform_real_distribution<float> place(0.0F, 1.0F);
  std::vector<LightBounds> lights(kLights);
  for (LightBounds& light : lights) {
    for (float& coordinate : light.least) {
      coordinate = place(random);
    }
    light.most = light.least;
    light.spread = kPi;
    light.intensity = 1.0F;
  }
  return lights;
}

TEST(LightBranchesTest, APointAmidManyLightsTakesThoseBesideIt) {
  std::mt19937 random(4);
  const std::vector<LightBounds> lights = cloud(random);
  const LightTree tree(lights);
  const LightBranches branches(tree);
  std::uniform_real_distribution<float> inside(0.2F, 0.8F);
  constexpr int kPoints = 40;
  double worst = 0;
  double mean = 0;
  for (int i = 0; i < kPoints; ++i) {
    LitPoint point;
    for (float& coordinate : point.place) {
      coordinate = inside(random);
    }
    double sum = 0;
    double squares = 0;
    double chances = 0;
    for (std::uint32_t position = 0; position < kLights; ++position) {
      const Vec3 towards = lights[tree.lightAt(position)].least - point.place;
      const auto chance = static_cast<double>(branches.leafOf(point, position).probability);
      const double given =
          static_cast<double>(std::max(towards.normalized().dot(point.normal), 0.0F) / towards.squaredNorm());
      chances += chance;
      sum += given;
      squares += given > 0.0 ? given * given / chance : 0.0;
    }
    EXPECT_LT(chances, 1.0 + 1e-4);  // less than 1 where a way down ends at lights behind the point
    mean += squares / (sum * sum) / kPoints;
    worst = std::max(worst, squares / (sum * sum));
  }
  // The second moment of an estimate by one light, over the square of its mean: 1 were no noise. Here 2.0 and 2.5; were
  // lights within a ball told from its rim alone, 3.4 and 13.
  EXPECT_LT(mean, 2.4);
  EXPECT_LT(worst, 4.0);
}

}  // namespace
}  // namespace metamer::spectral_ref
