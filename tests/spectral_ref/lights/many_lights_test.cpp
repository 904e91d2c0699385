// SPDX-License-Identifier: Apache-2.0
// A wall of a million lamps, of which each point of a plate needs its own few.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "integrator/sampler.h"
#include "spectral_ref/picture_fixture.h"
#include "spectral_ref/scene_fixture.h"

namespace metamer::spectral_ref {
namespace {

constexpr int kSide = 1000;

double peakMebibytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

/// Drives from 0 to 1, few of them near 1: every lamp is unlike its neighbours, and each side of the wall unlike the
/// other.
std::vector<float> drives() {
  std::vector<float> values(std::size_t{kSide} * kSide);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float right = static_cast<float>(i % kSide) / kSide;
    const float down = static_cast<float>(i / kSide) / kSide;
    values[i] = std::pow(unitFloat(hash32(static_cast<std::uint32_t>(i))), 8.0F) * right * down;
  }
  return values;
}

/// The sum over all lamps of drive times cosines over distance squared, times a lamp's area, at a place of the plate.
/// The wall is one wide and high, half above the plate, and shines down; its picture's top row lies at -z.
double formAt(const Vector3& place, const std::vector<float>& values) {
  constexpr double kHeight = 0.5;
  double sum = 0;
  for (int row = 0; row < kSide; ++row) {
    const double dz = (row + 0.5) / kSide - 0.5 - place.z();
    for (int column = 0; column < kSide; ++column) {
      const double dx = (column + 0.5) / kSide - 0.5 - place.x();
      const double squared = kHeight * kHeight + dx * dx + dz * dz;
      sum += static_cast<double>(values[static_cast<std::size_t>(row) * kSide + static_cast<std::size_t>(column)]) /
             (squared * squared);
    }
  }
  return sum * kHeight * kHeight / (static_cast<double>(kSide) * kSide);
}

TEST(ManyLightsTest, AMillionLampsAddUp) {
  const std::vector<float> values = drives();
  const auto file = exrFile("many_lights_test", kSide, kSide, 1, values);
  // One place of the plate, seen from below the wall. The plate faces up, the wall's u x v points down.
  const Vector3 place(0.2, 0.0, 0.1);
  const Scene scene = sceneOf(
      "metamer_scene: 1\n"
      "film: {width: 4, height: 4}\n"
      "camera: {origin: [0.2, 0.3, 0.2], target: [0.2, 0, 0.1], up: [0, 0, -1], fov_x: 0.01}\n"
      "integrator: {max_depth: 2, wavelengths: 4}\n"
      "shapes:\n"
      "  - rectangle: {center: [0, 0, 0], half_u: [2, 0, 0], half_v: [0, 0, -2]}\n    diffuse: 0.5\n"
      "  - led_wall: {center: [0, 0.5, 0], half_u: [-0.5, 0, 0], half_v: [0, 0, -0.5], picture: " +
      file.string() + ", emitters: [1], scale: 10}\n");
  ASSERT_EQ(scene.pictures[0].drives.size(), std::size_t{kSide} * kSide);
  // u runs to -x here, so that the wall faces down.
  const double expected = 0.5 / M_PI * 10.0 * formAt(Vector3(-place.x(), place.y(), place.z()), values);
  for (const Restir restir : {Restir::Off, Restir::Hero, Restir::Lanes}) {
    // Means over seeds: pixels of one picture share samples.
    constexpr int kSeeds = 6;
    double sum = 0;
    double squares = 0;
    for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
      const double mean = luminanceOver(rendered(scene, 256, {seed, false, restir}), 0, 0, 4, 4).mean;
      sum += mean / kSeeds;
      squares += mean * mean / kSeeds;
    }
    const double error = std::sqrt((squares - sum * sum) / (kSeeds - 1));
    const double z = (sum - expected) / error;
    // Student's t with 5 degrees of freedom, three cases: 8.6 is kept with 99.9 %.
    EXPECT_LT(std::abs(z), 8.6) << sum / expected;
    EXPECT_LT(error, 5e-3 * expected);
    std::printf("a million lamps, restir %d: %.5f of the sum, error %.1e, z %+.2f, peak memory %.0f MiB\n",
                static_cast<int>(restir), sum / expected, error / expected, z, peakMebibytes());
  }
}

}  // namespace
}  // namespace metamer::spectral_ref
