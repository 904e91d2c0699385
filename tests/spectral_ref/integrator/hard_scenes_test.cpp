// SPDX-License-Identifier: Apache-2.0
// Scenes at the edge of what can be rendered: they finish, and what they show is what they must.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "spectral/temporary_folder.h"
#include "spectral_ref/scene_fixture.h"

namespace metamer::spectral_ref {
namespace {

const std::string kStart =
    "metamer_scene: 1\n"
    "film: {width: 16, height: 16, bins: {from: 400, to: 760, step: 20}}\n"
    "camera: {origin: [0, 0, 10], target: [0, 0, 0], up: [0, 1, 0], fov_x: 8}\n"
    "integrator: {max_depth: 6, wavelengths: 4}\n";
const std::string kWall =
    "  - rectangle: {center: [0, 0, 0], half_u: [2, 0, 0], half_v: [0, 2, 0]}\n    diffuse: 0.5\n";
const std::string kEvenLight = "lights: [{environment: {emission: 1}}]\n";

AreaMean meanOf(const Film& film) {
  return luminanceOver(film, 0, 0, film.format().width, film.format().height);
}

class HardSceneTest : public testing::TestWithParam<RenderOptions> {};

TEST_P(HardSceneTest, ALampOfOneLine) {
  // 1 nm wide: one cell of 401. Whoever guides knows where it is.
  const Scene scene = sceneOf(kStart +
                              "spectra: {sodium: {wavelengths: [588, 589, 590], values: [0, 500, 0]}}\n"
                              "lights: [{point: {position: [3, 0, 4], intensity: sodium}}]\n"
                              "shapes:\n" +
                              kWall);
  const Film film = rendered(scene, 256, GetParam());
  // rho / pi I cos / r^2 at the middle of the wall; over the small part that is seen it changes little.
  const auto curves = scene.film.observer.onDomain();
  const double expected = 0.5 / M_PI * 500.0 * 0.8 / 25.0 * curves(589 - 380, 1) / curves.col(1).sum();
  const AreaMean mean = luminanceOver(film, 4, 4, 8, 8);
  EXPECT_NEAR(mean.mean, expected, 4.0 * mean.error + 0.01 * expected);
  EXPECT_GT(mean.mean, 0.0);
  for (int bin = 0; bin < film.format().bins.count; ++bin) {
    // Power is linear between whole nanometres: a twelfth of the line's lies beyond 590 nm, in the bin of 600.
    const double distance = std::abs(film.format().bins.centreNm(bin) - 589.0);
    EXPECT_EQ(meanRadiance(film, bin) > 0.0, distance < 12.0) << film.format().bins.centreNm(bin);
    if (distance > 10.0 && distance < 12.0) {
      EXPECT_LE(meanRadiance(film, bin), 0.15 * meanRadiance(film, bin - 1));
    }
  }
  EXPECT_EQ(film.refused, 0U);
}

TEST_P(HardSceneTest, BlackScenesAreBlack) {
  // Nothing; no light; light of no power; paint that gives nothing back.
  for (const std::string& rest :
       {std::string(), "shapes:\n" + kWall, "lights: [{environment: {emission: 0}}]\nshapes:\n" + kWall,
        kEvenLight +
            "shapes:\n  - rectangle: {center: [0, 0, 0], half_u: [2, 0, 0], half_v: [0, 2, 0]}\n    diffuse: 0\n"}) {
    const Film film = rendered(sceneOf(kStart + rest), 8, GetParam());
    EXPECT_EQ(meanOf(film).mean, 0.0) << rest;
    EXPECT_EQ(film.refused, 0U);
  }
}

TEST_P(HardSceneTest, AFullyAbsorbingFilterLetsNothingThrough) {
  const Film film = rendered(
      sceneOf(kStart + kEvenLight + "shapes:\n" + kWall + "  - sphere: {center: [0, 0, 0], radius: 5}\n    gel: 0\n"),
      8, GetParam());
  EXPECT_EQ(meanOf(film).mean, 0.0);
  EXPECT_EQ(film.refused, 0U);
}

TEST_P(HardSceneTest, CoincidentSurfaces) {
  // Two equal walls in one plane: whichever is hit, the light is that of one. The room behind stays dark.
  const auto scene = [](const std::string& walls) {
    return sceneOf(kStart + "lights: [{point: {position: [3, 0, 4], intensity: 7}}]\nshapes:\n" + walls);
  };
  const AreaMean one = meanOf(rendered(scene(kWall), 64, GetParam()));
  const AreaMean two = meanOf(rendered(scene(kWall + kWall), 64, GetParam()));
  ASSERT_GT(one.mean, 0.0);
  EXPECT_NEAR(two.mean, one.mean, 4.0 * std::hypot(one.error, two.error) + 1e-6 * one.mean);
}

INSTANTIATE_TEST_SUITE_P(Integrators, HardSceneTest,
                         testing::Values(RenderOptions{}, RenderOptions{0, true, Restir::Off},
                                         RenderOptions{0, false, Restir::Hero}, RenderOptions{0, true, Restir::Lanes}));

TEST(HardSceneTest, GuidingFindsOneLine) {
  const Scene scene = sceneOf(kStart +
                              "spectra: {sodium: {wavelengths: [588, 589, 590], values: [0, 500, 0]}}\n"
                              "lights: [{point: {position: [3, 0, 4], intensity: sodium}}]\n"
                              "shapes:\n" +
                              kWall);
  const AreaMean uniform = meanOf(rendered(scene, 64));
  const AreaMean guided = meanOf(rendered(scene, 64, {0, true, Restir::Off}));
  EXPECT_LT(guided.error, 0.1 * uniform.error);
}

TEST(HardSceneTest, ALightSeenOnlyThroughDispersiveGlass) {
  // A lamp inside a glass ball: next-event estimation never reaches it. Paths find it by chance, and what they find is
  // kept: with the lamp's whole power, the mean of many seeds is above what clipping to few times the mean would leave.
  const Scene scene = sceneOf(kStart + "shapes:\n" + kWall +
                              "  - sphere: {center: [0, 1.2, 1], radius: 0.4}\n"
                              "    dielectric: {index: {cauchy: [1.5, 0.02]}}\n"
                              "  - sphere: {center: [0, 1.2, 1], radius: 0.1}\n    emission: 100\n");
  const Film film = rendered(scene, 256);
  const Film other = rendered(scene, 256, {1, false, Restir::Off});
  const AreaMean mean = meanOf(film);
  const AreaMean same = meanOf(other);
  EXPECT_EQ(film.refused, 0U);
  ASSERT_GT(mean.mean, 0.0);
  EXPECT_NEAR(mean.mean, same.mean, 4.0 * std::hypot(mean.error, same.error));
  // Fireflies are there: the brightest pixel lies far above the mean.
  double brightest = 0;
  for (std::size_t pixel = 0; pixel < film.format().pixels(); ++pixel) {
    brightest = std::max(brightest, film.luminance(pixel).mean);
  }
  EXPECT_GT(brightest, 3.0 * mean.mean);
}

TEST(HardSceneTest, DegenerateTrianglesAndPlacesThatAreNoNumberAreLeftOut) {
  const std::filesystem::path file = scratchFile("hard_scenes.obj");
  const std::string good = "v -2 -2 0\nv 2 -2 0\nv 2 2 0\nv -2 2 0\nf 1 2 3\nf 1 3 4\n";
  const auto scene = [&](const std::string& text) {
    std::ofstream(file) << text;
    return parseScene(kStart + kEvenLight + "shapes:\n  - mesh: " + file.string() + "\n    diffuse: 0.5\n",
                      "scene.yaml", {}, spectral::testLibrary());
  };
  const Scene whole = scene(good);
  EXPECT_EQ(whole.meshes[0].dropped, 0);
  // No area (twice the same corner; three in a line) and a corner that is no number.
  const Scene damaged = scene(good + "v 0 0 1\nv 1 1 1\nv 2 2 1\nv nan 0 1\nf 1 1 2\nf 5 6 7\nf 5 6 8\n");
  EXPECT_EQ(damaged.meshes[0].dropped, 3);
  ASSERT_EQ(damaged.warnings.size(), 1U);
  EXPECT_NE(damaged.warnings[0].find('3'), std::string::npos) << damaged.warnings[0];
  EXPECT_EQ(rendered(damaged, 16).sums(), rendered(whole, 16).sums());
}

}  // namespace
}  // namespace metamer::spectral_ref
