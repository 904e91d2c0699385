// SPDX-License-Identifier: Apache-2.0
// Pixels at edges: found from the scene, and no darker or lighter for it.
#include "integrator/edge_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "spectral_ref/scene_fixture.h"

namespace metamer::spectral_ref {
namespace {

constexpr int kSide = 20;

/// A camera over the plane z = 0 that a pixel is 0.1 wide on.
std::string seen(const std::string& shapes, const std::string& lights = "") {
  return "metamer_scene: 1\n"
         "film: {width: 20, height: 20}\n"
         "camera: {origin: [0, 0, 10], target: [0, 0, 0], up: [0, 1, 0], fov_x: 11.4212}\n"
         "integrator: {max_depth: 2, wavelengths: 16}\n" +
         lights + "shapes:\n" + shapes;
}

/// Columns of the middle row that an edge runs through.
std::string edgesOf(const std::string& shapes) {
  const Scene scene = sceneOf(seen(shapes));
  const PreparedScene prepared(scene, {});
  EdgeMap edges(prepared);
  std::string columns;
  for (int x = 0; x < kSide; ++x) {
    edges.look(x, kSide / 2);
    if (edges.paths(static_cast<std::size_t>(kSide / 2 * kSide + x)) > 1) {
      columns += std::to_string(x) + " ";
    }
  }
  return columns;
}

TEST(EdgeMapTest, EdgesAreWhereMattersMeet) {
  const std::string board = "  - rectangle: {center: [-0.45, 0, 0], half_u: [0.4, 0, 0], half_v: [0, 2, 0]}\n    ";
  // From x = -0.85 to -0.05: through the middle of pixels 1 and 9.
  EXPECT_EQ(edgesOf(board + "diffuse: 0.5\n"), "1 9 ");
  // Where boards meet there is one edge, of two colours or of a lamp.
  const std::string next = "  - rectangle: {center: [0.45, 0, 0], half_u: [0.5, 0, 0], half_v: [0, 2, 0]}\n    ";
  EXPECT_EQ(edgesOf(board + "diffuse: 0.5\n" + next + "diffuse: 0.6\n"), "1 9 19 ");
  EXPECT_EQ(edgesOf(board + "diffuse: 0.5\n" + next + "emission: 1\n"), "1 9 19 ");
  // A ball's rim, not its middle.
  EXPECT_EQ(edgesOf("  - sphere: {center: [0, 0, 0], radius: 0.65}\n    diffuse: 0.5\n"), "3 16 ");
  EXPECT_EQ(edgesOf("  []\n"), "");
}

TEST(EdgeMapTest, WhatAnEdgeCoversComesOutExactly) {
  // A lamp's slanted border: a pixel that it crosses is as bright as the part of it that is covered. Many seeds.
  const Scene scene = sceneOf(
      seen("  - rectangle: {center: [-1.03, 0, 0], half_u: [1, 0.4, 0], half_v: [-0.8, 2, 0]}\n    emission: 1\n"));
  const Scene even = sceneOf(seen("  []\n", "lights: [{environment: {emission: 1}}]\n"));
  constexpr int kSeeds = 64;
  constexpr std::uint64_t kSamples = 16;
  // Where the border runs through the row's pixels: from the camera's geometry, by a fine grid.
  const double pixel = 2.0 * 10.0 * std::tan(0.5 * 11.4212 * M_PI / 180.0) / kSide;
  const auto covered = [&](int x) {
    constexpr int kSteps = 400;
    int inside = 0;
    for (int i = 0; i < kSteps * kSteps; ++i) {
      const double px = (x - 0.5 * kSide + (i % kSteps + 0.5) / kSteps) * pixel + 1.03;
      const double py = -(0.0 + (i / kSteps + 0.5) / kSteps) * pixel;
      // In units of the rectangle's halves: it ends where u is 1.
      const double u = (px * 2.0 - py * -0.8) / (1.0 * 2.0 - 0.4 * -0.8);
      inside += std::abs(u) <= 1.0 ? 1 : 0;
    }
    return static_cast<double>(inside) / (kSteps * kSteps);
  };
  int crossed = 0;
  double squares = 0;
  for (int x = 0; x < kSide; ++x) {
    const double expected = covered(x);
    if (expected < 0.02 || expected > 0.98) {
      continue;
    }
    ++crossed;
    double sum = 0;
    double sumOfSquares = 0;
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
      const auto at = static_cast<std::size_t>(kSide / 2 * kSide + x);
      const double value = rendered(scene, kSamples, {seed, false, Restir::Off}).luminance(at).mean /
                           rendered(even, kSamples, {seed, false, Restir::Off}).luminance(at).mean;
      sum += value;
      sumOfSquares += value * value;
    }
    const double mean = sum / kSeeds;
    const double variance = (sumOfSquares - kSeeds * mean * mean) / (kSeeds - 1);
    EXPECT_LT(std::abs(mean - expected), 4.0 * std::sqrt(variance / kSeeds) + 1e-3) << x << ": " << mean;
    squares += variance;
  }
  ASSERT_GE(crossed, 1);
  // One path a sample leaves 0.05 and more.
  EXPECT_LT(std::sqrt(squares / crossed), 0.035);
  std::printf("%d pixels, %d samples: root mean square error of coverage %.4f\n", crossed, static_cast<int>(kSamples),
              std::sqrt(squares / crossed));
}

}  // namespace
}  // namespace metamer::spectral_ref
