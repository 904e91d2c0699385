// SPDX-License-Identifier: Apache-2.0
// Rays in groups find what they find alone.
#include "geometry/embree_scene.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <string>

#include "spectral_ref/scene_fixture.h"

namespace metamer::spectral_ref {
namespace {

/// Boards and balls at random.
std::string clutter() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-2.0, 2.0);
  const auto vector = [&] {
    return "[" + std::to_string(place(random)) + ", " + std::to_string(place(random)) + ", " +
           std::to_string(place(random)) + "]";
  };
  std::string text = "metamer_scene: 1\nshapes:\n";
  for (int i = 0; i < 12; ++i) {
    text += "  - rectangle: {center: " + vector() + ", half_u: " + vector() + ", half_v: " + vector() + "}\n" +
            "    diffuse: 0.5\n" + "  - sphere: {center: " + vector() + ", radius: 0.4}\n    diffuse: 0.5\n";
  }
  return text;
}

TEST(EmbreeSceneTest, AGroupFindsWhatItsRaysFindAlone) {
  const Scene scene = sceneOf(clutter());
  const EmbreeScene shapes(scene);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-3.0F, 3.0F);
  int hits = 0;
  int misses = 0;
  for (int turn = 0; turn < 2000; ++turn) {
    RayGroup rays;
    for (std::size_t i = 0; i < kRaysTogether; ++i) {
      Ray ray;
      ray.origin = Vec3(place(random), place(random), place(random));
      ray.direction = (Vec3(place(random), place(random), place(random)) - ray.origin).normalized();
      ray.most = turn % 2 == 0 ? 1.5F : std::numeric_limits<float>::infinity();
      rays.set(i, ray);
    }
    // All, some, one in each packet, one in the second.
    constexpr std::array<RayMask, 4> kActive = {kAllRays, 0x5aa6U, 0x0410U, 0x1000U};
    const RayMask active = kActive[static_cast<std::size_t>(turn) % kActive.size()];
    HitGroup together;
    const RayMask found = shapes.intersect(rays, active, together);
    const RayMask hidden = shapes.occluded(rays, active);
    EXPECT_EQ(found & ~active, 0U);
    EXPECT_EQ(hidden & ~active, 0U);
    for (std::size_t i = 0; i < kRaysTogether; ++i) {
      const RayMask bit = RayMask{1} << i;
      if ((active & bit) == 0) {
        continue;
      }
      Hit alone;
      const bool isHit = shapes.intersect(rays[i], alone);
      ASSERT_EQ((found & bit) != 0, isHit);
      ASSERT_EQ((hidden & bit) != 0, isHit);
      ++(isHit ? hits : misses);
      if (isHit) {
        const Hit hit = together[i];
        EXPECT_EQ(hit.material, alone.material);
        EXPECT_NEAR(hit.distance, alone.distance, 1e-4F * (1.0F + alone.distance));
        EXPECT_LT((hit.normal - alone.normal).norm(), 1e-3F);
        EXPECT_LT((hit.position - alone.position).norm(), 1e-4F * (1.0F + alone.distance));
      }
    }
  }
  EXPECT_GT(hits, 1000);
  EXPECT_GT(misses, 1000);
}

}  // namespace
}  // namespace metamer::spectral_ref
