// SPDX-License-Identifier: Apache-2.0
// Gels that know the angle, against Snell, Fresnel and Bouguer by their angles and a sum over reflections to and fro,
// where the renderer has the sum's closed form and no angles.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "spectral_ref/scene_fixture.h"

namespace metamer::spectral_ref {
namespace {

/// What a sheet passes whose matter passes `within` straight on. @param angle  outside, radians
double sheetPasses(double index, double within, double angle) {
  const double inside = std::asin(std::sin(angle) / index);
  double across = 0;
  double parallel = 0;
  if (angle > 0) {
    across = std::pow(std::sin(angle - inside) / std::sin(angle + inside), 2);
    parallel = std::pow(std::tan(angle - inside) / std::tan(angle + inside), 2);
  } else {
    across = parallel = std::pow((index - 1) / (index + 1), 2);
  }
  const double once = std::pow(within, 1 / std::cos(inside));
  double sum = 0;
  for (const double face : {across, parallel}) {
    double light = (1 - face) * once;  // within the sheet, at its second face
    for (int i = 0; i < 200; ++i) {
      sum += 0.5 * light * (1 - face);
      light *= face * once * face * once;
    }
  }
  return sum;
}

/// The matter of a sheet that passes so much straight on.
double matterOf(double index, double passes) {
  double low = 0;
  double high = 1;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (sheetPasses(index, middle, 0) < passes ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// A camera that sees even light through a gel, turned about the vertical.
double seenThrough(const std::string& gel, double degrees) {
  const double angle = degrees * M_PI / 180;
  return luminanceOver(rendered(sceneOf("metamer_scene: 1\n"
                                        "film: {width: 4, height: 4}\n"
                                        "camera: {origin: [0, 0, 5], target: [0, 0, 0], up: [0, 1, 0], fov_x: 0.01}\n"
                                        "integrator: {wavelengths: 4}\n"
                                        "lights: [{environment: {emission: 1}}]\n"
                                        "shapes:\n"
                                        "  - rectangle: {center: [0, 0, 0], half_u: [" +
                                        std::to_string(std::cos(angle)) + ", 0, " + std::to_string(std::sin(angle)) +
                                        "], half_v: [0, 1, 0]}\n    gel: " + gel + "\n"),
                                64),
                       0, 0, 4, 4)
      .mean;
}

TEST(GelSheetTest, WhatIsSeenThroughItFallsWithTheAngle) {
  const double nothing = seenThrough("1", 0);
  for (const double index : {1.0, 1.49, 2.0}) {
    for (const double passes : {0.75, 0.3, 0.02}) {
      const std::string gel = "{transmittance: " + std::to_string(passes) + ", index: " + std::to_string(index) + "}";
      EXPECT_NEAR(seenThrough(gel, 0) / nothing, passes, 1e-5 * passes) << gel;
      for (const double degrees : {20.0, 45.0, 70.0, 85.0}) {
        const double expected = sheetPasses(index, matterOf(index, passes), degrees * M_PI / 180);
        EXPECT_NEAR(seenThrough(gel, degrees) / nothing, expected, 1e-4 * expected + 1e-12) << gel << " at " << degrees;
      }
      EXPECT_NEAR(seenThrough(std::to_string(passes), 70) / nothing, passes, 1e-5 * passes);
    }
  }
  EXPECT_EQ(seenThrough("{transmittance: 0, index: 1.49}", 30), 0.0);
}

TEST(GelSheetTest, LightThroughItIsColouredByTheAngleToo) {
  // A point lamp over a surface, at 50 degrees to the gel between.
  const auto lit = [](const std::string& shapes) {
    const Scene scene = sceneOf(
        "metamer_scene: 1\n"
        "film: {width: 4, height: 4}\n"
        "camera: {origin: [0, 0.2, 1], target: [0, 0, 0], up: [0, 1, 0], fov_x: 0.01}\n"
        "integrator: {max_depth: 2, wavelengths: 4}\n"
        "lights: [{point: {position: [" +
        std::to_string(9 * std::sin(50 * M_PI / 180)) + ", 0, " + std::to_string(9 * std::cos(50 * M_PI / 180)) +
        "], intensity: 50}}]\n"
        "shapes:\n"
        "  - rectangle: {center: [0, 0, 0], half_u: [1, 0, 0], half_v: [0, 1, 0]}\n    diffuse: 0.5\n" +
        shapes);
    return luminanceOver(rendered(scene, 16), 0, 0, 4, 4).mean;
  };
  const double expected = sheetPasses(1.49, matterOf(1.49, 0.4), 50 * M_PI / 180);
  const double passed = lit("  - rectangle: {center: [0, 0, 3], half_u: [9, 0, 0], half_v: [0, 9, 0]}\n"
                            "    gel: {transmittance: 0.4, index: 1.49}\n") /
                        lit("");
  EXPECT_NEAR(passed, expected, 1e-4);
}

TEST(GelSheetTest, WhatNoSheetIsIsRefused) {
  const auto refusal = [](const std::string& gel) { return spectral::errorOf([&] { seenThrough(gel, 0); }); };
  EXPECT_NE(refusal("{transmittance: 0.95, index: 1.5}").find("more than the 0.92"), std::string::npos);
  EXPECT_NE(refusal("{transmittance: 0.5}").find("index"), std::string::npos);
  EXPECT_NE(refusal("{index: 1.5}").find("transmittance"), std::string::npos);
  EXPECT_NE(refusal("{transmittance: 0.5, index: 0.9}").find("index"), std::string::npos);
}

}  // namespace
}  // namespace metamer::spectral_ref
