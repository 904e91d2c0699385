// SPDX-License-Identifier: Apache-2.0
// What is worked out for many paths at once is what it is for one.
#include "integrator/diffuse_group.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <string>

#include "integrator/prepared_scene.h"
#include "spectral_ref/scene_fixture.h"

namespace metamer::spectral_ref {
namespace {

constexpr const char* kLamp = "  - rectangle: {center: [1, 2, 3], half_u: [0, 0.5, 0], half_v: [0.25, 0, 0.5]}\n";
constexpr const char* kFloor = "  - rectangle: {center: [0, 0, 0], half_u: [1, 0, 0], half_v: [0, 1, 0]}\n";

Scene withLamps(const std::string& more, const std::string& filter = "") {
  return sceneOf("metamer_scene: 1\nfilm: {width: 8, height: 6" + filter +
                 "}\n"
                 "shapes:\n" +
                 kLamp + "    emission: 2\n" + kFloor + more);
}

EachRay<float> numbers(unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<float> uniform(0.0F, 0.999F);
  EachRay<float> result{};
  for (float& number : result) {
    number = uniform(engine);
  }
  return result;
}

TEST(DiffuseGroupTest, PointsOfTheOnlyLightAreItsPoints) {
  const Scene scene = withLamps("    diffuse: 0.5\n");
  const PreparedScene prepared(scene, {});
  const RectangleEmitter* lamp = prepared.lights.onlyRectangle();
  ASSERT_NE(lamp, nullptr);
  const EachRay<float> u = numbers(1);
  const EachRay<float> v = numbers(2);
  LightsOfGroup lights;
  pointsOn(*lamp, u, v, lights);
  for (std::size_t i = 0; i < kRaysTogether; ++i) {
    const auto point = prepared.lights.areaPoint({0, u[i], v[i]});
    ASSERT_TRUE(point);
    EXPECT_LT((lights.place[i] - point->place).norm(), 1e-6F);
    EXPECT_EQ(lights.area[i], point->area);
    EXPECT_EQ(lights.chance[i], prepared.lights.probability(0));
  }
}

TEST(DiffuseGroupTest, ALightThatIsOneOfSeveralOrRoundIsNotTheOnlyRectangle) {
  EXPECT_EQ(PreparedScene(withLamps("    emission: 1\n"), {}).lights.onlyRectangle(), nullptr);
  EXPECT_EQ(
      PreparedScene(withLamps("    diffuse: 0.5\nlights: [{environment: {emission: 1}}]\n"), {}).lights.onlyRectangle(),
      nullptr);
  const Scene round = sceneOf(
      "metamer_scene: 1\nfilm: {width: 2, height: 2}\nshapes:\n"
      "  - sphere: {center: [0, 0, 0], radius: 1}\n    emission: 2\n");
  EXPECT_EQ(PreparedScene(round, {}).lights.onlyRectangle(), nullptr);
}

TEST(DiffuseGroupTest, FrontsAreThoseThatRaysComeTo) {
  RayGroup rays;
  HitGroup hits;
  RayMask expected = 0;
  const EachRay<float> x = numbers(3);
  for (std::size_t i = 0; i < kRaysTogether; ++i) {
    rays.direction.set(i, Vec3(x[i] - 0.5F, 0.3F, i % 3 == 0 ? 0.2F : -0.4F));
    hits.normal.set(i, Vec3(0.6F, 0, 0.8F));
    expected |= rays.direction[i].dot(hits.normal[i]) < 0.0F ? RayMask{1} << i : 0U;
  }
  EXPECT_EQ(onFront(rays, hits), expected);
  EXPECT_NE(expected, 0U);
  EXPECT_NE(expected, kAllRays);
}

TEST(DiffuseGroupTest, CameraRaysOfManyPixelsAreThoseOfEach) {
  for (const char* filter : {", filter: {box: 0.5}", ", filter: {gaussian: 1.5}"}) {
    const Scene scene = withLamps("    diffuse: 0.5\n", filter);
    const PreparedScene prepared(scene, {});
    const EachRay<float> u = numbers(4);
    const EachRay<float> v = numbers(5);
    EachRay<int> x{};
    EachRay<int> y{};
    for (std::size_t i = 0; i < kRaysTogether; ++i) {
      x[i] = static_cast<int>(i) % 8;
      y[i] = static_cast<int>(i) / 3;
    }
    RayGroup rays;
    prepared.camera.filteredRays(x, y, u, v, rays);
    for (std::size_t i = 0; i < kRaysTogether; ++i) {
      const Eigen::Vector2f place = prepared.camera.filtered(x[i], y[i], {u[i], v[i]});
      const Ray ray = prepared.camera.ray(place.x(), place.y());
      EXPECT_LT((rays.direction[i] - ray.direction).norm(), 1e-6F) << filter;
      EXPECT_EQ(rays.origin[i], ray.origin);
    }
  }
}

}  // namespace
}  // namespace metamer::spectral_ref
