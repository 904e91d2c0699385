// SPDX-License-Identifier: Apache-2.0
// Far from all lights the last surface of a path asks them alone, near them it also follows its reflectance: both give
// the integral over the lamp.
#include "lights/light_reach.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "integrator/prepared_scene.h"
#include "spectral_ref/scene_fixture.h"

namespace metamer::spectral_ref {
namespace {

/// A square lamp over a floor, which is looked at from the side, below the lamp.
std::string overFloor(double height, int depth) {
  return "metamer_scene: 1\n"
         "film: {width: 2, height: 2}\n"
         "camera: {origin: [9, 0, 1.5], target: [0, 0, 0], up: [0, 0, 1], fov_x: 0.001}\n"
         "integrator: {max_depth: " +
         std::to_string(depth) +
         ", wavelengths: 16}\n"
         "shapes:\n"
         "  - rectangle: {center: [0, 0, 0], half_u: [1, 0, 0], half_v: [0, 1, 0]}\n    diffuse: 0.5\n"
         "  - rectangle: {center: [0, 0, " +
         std::to_string(height) + "], half_u: [0, 1, 0], half_v: [1, 0, 0]}\n    emission: 2\n";
}

/// Irradiance over radiance below the middle of a square of half side 1 at a height.
double formFactor(double height) {
  constexpr int kSteps = 1000;
  double sum = 0;
  for (int i = 0; i < kSteps * kSteps; ++i) {
    const double x = 2.0 * (i % kSteps + 0.5) / kSteps - 1.0;
    const double y = 2.0 * (i / kSteps + 0.5) / kSteps - 1.0;
    sum += std::pow(height / (x * x + y * y + height * height), 2) * 4.0 / (kSteps * kSteps);
  }
  return sum;
}

TEST(LightReachTest, NearIsWhatALampsSizeSays) {
  const Scene scene = sceneOf(overFloor(3, 2));
  const PreparedScene prepared(scene, {});
  // Half its diagonal is the root of 2: near is up to twice that.
  EXPECT_TRUE(prepared.lightReach.isNear({0, 0, 0.2F}));
  EXPECT_FALSE(prepared.lightReach.isNear({0, 0, 0.1F}));
  EXPECT_TRUE(prepared.lightReach.isNear({3.8F, 0, 3}));
  EXPECT_FALSE(prepared.lightReach.isNear({3.9F, 0, 3}));
  const Scene open = sceneOf(overFloor(3, 2) + "lights: [{environment: {emission: 1}}]\n");
  EXPECT_TRUE(PreparedScene(open, {}).lightReach.isNear({0, 0, -100}));
}

TEST(LightReachTest, ManyPlacesAreAsOne) {
  const Scene scene = sceneOf(overFloor(3, 2));
  const PreparedScene prepared(scene, {});
  HitGroup hits;
  RayMask near = 0;
  for (std::size_t i = 0; i < kRaysTogether; ++i) {
    // Across the border that is 3.83 off, in steps that do not meet it.
    const float along = 3.0F + 0.11F * static_cast<float>(i);
    hits.position.set(i, i % 2 == 0 ? Vec3(along, 0, 3) : Vec3(0, -along, 3));
    near |= prepared.lightReach.isNear(hits.position[i]) ? RayMask{1} << i : 0U;
  }
  EXPECT_EQ(prepared.lightReach.areNear(hits), near);
  EXPECT_NE(near, 0U);
  EXPECT_NE(near, kAllRays);
}

TEST(LightReachTest, LightIsWholeOnEitherSide) {
  const double nothing = luminanceOver(rendered(sceneOf("metamer_scene: 1\nfilm: {width: 2, height: 2}\n"
                                                        "integrator: {wavelengths: 16}\n"
                                                        "lights: [{environment: {emission: 1}}]\n"),
                                                256),
                                       0, 0, 2, 2)
                             .mean;
  for (const double height : {0.3, 1.0, 2.7, 2.9, 6.0}) {
    const double expected = 0.5 * 2.0 / M_PI * formFactor(height);
    // With a third edge the path goes on: the lamp reflects nothing, so the light is the same.
    for (const int depth : {2, 3}) {
      const AreaMean mean = luminanceOver(rendered(sceneOf(overFloor(height, depth)), 1024), 0, 0, 2, 2);
      EXPECT_LT(std::abs(mean.mean / nothing - expected), 4.0 * mean.error + 2e-4 * expected)
          << height << ", " << depth << " edges: " << mean.mean / nothing << " against " << expected;
    }
  }
}

}  // namespace
}  // namespace metamer::spectral_ref
