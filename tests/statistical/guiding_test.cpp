// SPDX-License-Identifier: Apache-2.0
// What guided wavelengths cost the channels in which a scene has little light.
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "spectral_ref/scene_fixture.h"

namespace metamer::spectral_ref {
namespace {

/// Mean square error of X, Y and Z over the pixels and a few seeds.
Eigen::Array3d errorOf(const Scene& scene, const Film& truth, bool isGuided) {
  constexpr std::uint32_t kSeeds = 4;
  Eigen::Array3d squares = Eigen::Array3d::Zero();
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    const Film film = rendered(scene, 16, {seed, isGuided, Restir::Off});
    for (std::size_t pixel = 0; pixel < film.format().pixels(); ++pixel) {
      squares += (film.colour(pixel) - truth.colour(pixel)).array().square();
    }
  }
  return squares / static_cast<double>(kSeeds * truth.format().pixels());
}

class GuidingTest : public testing::TestWithParam<const char*> {};

TEST_P(GuidingTest, NoChannelIsMuchNoisierThanWithUniformWavelengths) {
  // A chart in one plane, each patch so large that few pixels lie on an edge.
  const Scene scene = sceneOf(
      std::string("metamer_scene: 1\n"
                  "film: {width: 48, height: 32, space: XYZ}\n"
                  "camera: {origin: [0, 0, 10], target: [0, 0, 0], up: [0, 1, 0], fov_x: 34}\n"
                  "integrator: {max_depth: 2, wavelengths: 4}\n"
                  "shapes:\n"
                  "  - chart: {center: [0, 0, 0], half_u: [3.5, 0, 0], half_v: [0, 2.5, 0], columns: 6, gap: 0}\n"
                  "  - rectangle: {center: [-3, 4, 6], half_u: [0.3, 0, 0], half_v: [0, 0, 0.3]}\n") +
      GetParam());
  const Film truth = rendered(scene, 1024, {777, false, Restir::Off});
  const Eigen::Array3d gain = errorOf(scene, truth, false) / errorOf(scene, truth, true);
  std::printf("uniform over guided, X Y Z: %.2f %.2f %.2f\n", gain[0], gain[1], gain[2]);
  EXPECT_GT(gain.minCoeff(), 0.7);
  EXPECT_GT(gain[1], 1.5);
}

INSTANTIATE_TEST_SUITE_P(Lamps, GuidingTest,
                         testing::Values("    emission: HP1\n",
                                         "    emission: A\n"
                                         "  - rectangle: {center: [-3, 3.8, 6], half_u: [2, 0, 0], half_v: [0, 0, 2]}\n"
                                         "    gel: Lee 106 Primary Red\n"));

}  // namespace
}  // namespace metamer::spectral_ref
