// SPDX-License-Identifier: Apache-2.0
// White furnace: whatever gives back all light is invisible in even light, at every wavelength.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "spectral_ref/scene_fixture.h"

namespace metamer::spectral_ref {
namespace {

struct FurnaceCase {
  const char* name;
  const char* shapes;
  int wavelengths;
  int samples;  ///< so many that noise is well below what is asked: more where a path has one wavelength, or loses some
};

std::ostream& operator<<(std::ostream& stream, const FurnaceCase& furnace) {
  return stream << furnace.name;
}

class FurnaceTest : public testing::TestWithParam<FurnaceCase> {};

std::string furnace(int wavelengths, const std::string& shapes) {
  return "metamer_scene: 1\n"
         "film: {width: 32, height: 32, bins: {from: 380, to: 780, step: 50}}\n"
         "camera: {origin: [0, 0, 4], target: [0, 0, 0], up: [0, 1, 0], fov_x: 40}\n"
         "integrator: {max_depth: 64, russian_roulette: 5, wavelengths: " +
         std::to_string(wavelengths) +
         "}\n"
         "lights: [{environment: {emission: 1}}]\n"
         "shapes:\n" +
         shapes;
}

TEST_P(FurnaceTest, IsOneInEveryBin) {
  const Film film = rendered(sceneOf(furnace(GetParam().wavelengths, GetParam().shapes)), GetParam().samples);
  // The same wavelengths with nothing there: what is left is the light that the shapes made or lost.
  const Film empty = rendered(sceneOf(furnace(GetParam().wavelengths, "  []\n")), GetParam().samples);
  double largest = 0;
  for (int bin = 0; bin < film.format().bins.count; ++bin) {
    largest = std::max(largest, std::abs(meanRadiance(film, bin) / meanRadiance(empty, bin) - 1.0));
  }
  EXPECT_LT(largest, 1e-3);
  std::printf("%s, %d wavelengths: largest |1 - radiance| of a bin %.1e\n", GetParam().name, GetParam().wavelengths,
              largest);
}

constexpr const char* kDiffuse =
    "  - sphere: {center: [0, 0, 0], radius: 1}\n    diffuse: 1\n"
    // A corner, so that light goes to and fro many times.
    "  - rectangle: {center: [0, -1.2, 0], half_u: [0, 0, 2], half_v: [2, 0, 0]}\n    diffuse: 1\n";
constexpr const char* kConductor =
    "  - sphere: {center: [-0.6, 0, 0], radius: 0.6}\n    conductor: {reflectance: 1, roughness: 0.8}\n"
    "  - sphere: {center: [0.6, 0, 0], radius: 0.6}\n    conductor: {reflectance: 1, roughness: 0.1}\n";
constexpr const char* kGlass = "  - sphere: {center: [0, 0, 0], radius: 1}\n    dielectric: {index: 1.5}\n";
constexpr const char* kPrism =
    "  - sphere: {center: [0, 0, 0], radius: 1}\n    dielectric: {index: {cauchy: [1.5, 0.01]}}\n";
constexpr const char* kClearGel =
    "  - rectangle: {center: [0, 0, 1.5], half_u: [2, 0, 0], half_v: [0, 2, 0]}\n    gel: 1\n"
    "  - sphere: {center: [0, 0, 0], radius: 1}\n    diffuse: 1\n";

INSTANTIATE_TEST_SUITE_P(
    Materials, FurnaceTest,
    testing::Values(FurnaceCase{"diffuse", kDiffuse, 1, 4096}, FurnaceCase{"diffuse", kDiffuse, 4, 1024},
                    FurnaceCase{"diffuse", kDiffuse, 16, 512}, FurnaceCase{"gel", kClearGel, 4, 1024},
                    FurnaceCase{"conductor", kConductor, 4, 512}, FurnaceCase{"smooth glass", kGlass, 4, 256},
                    FurnaceCase{"dispersive glass", kPrism, 4, 2048},
                    FurnaceCase{"dispersive glass", kPrism, 16, 1024}));

TEST(FurnaceTest, AGreySphereLosesWhatItShould) {
  // A convex body in even light: each point sees the light alone, so its radiance is its reflectance.
  const Film film =
      rendered(sceneOf(furnace(4, "  - sphere: {center: [0, 0, 0], radius: 1.4}\n    diffuse: 0.3\n")), 16);
  const AreaMean middle = luminanceOver(film, 12, 12, 8, 8);
  EXPECT_NEAR(middle.mean, 0.3, 4.0 * middle.error);
}

}  // namespace
}  // namespace metamer::spectral_ref
