// SPDX-License-Identifier: Apache-2.0
// The same bits whatever the threads, the passes and the parts a render is cut into.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>

#include "metamer/spectral_ref/exr_film.h"
#include "spectral/temporary_folder.h"
#include "spectral_ref/scene_fixture.h"

namespace metamer::spectral_ref {
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();

const Scene& scene() {
  static const Scene chart = sceneOf(chartScene(4, "FL11", 50, 35));
  return chart;
}

class ReproducibleTest : public testing::TestWithParam<RenderOptions> {};

TEST_P(ReproducibleTest, AnyNumberOfThreads) {
  const Film one = rendered(scene(), 24, GetParam(), 1);
  for (const int threads : {2, 3, 7}) {
    EXPECT_EQ(rendered(scene(), 24, GetParam(), threads).sums(), one.sums()) << threads;
  }
}

TEST_P(ReproducibleTest, AnyNumberOfPasses) {
  const Film whole = rendered(scene(), 24, GetParam());
  Renderer renderer(scene(), GetParam());
  for (const std::uint64_t end : {1U, 2U, 9U, 16U, 24U}) {
    renderer.render(end, kForever);
    EXPECT_EQ(renderer.nextSample(), end);
  }
  EXPECT_EQ(renderer.film().sums(), whole.sums());
}

TEST_P(ReproducibleTest, ACheckpointGoesOnBitByBit) {
  const Film whole = rendered(scene(), 90, GetParam());
  Renderer first(scene(), GetParam());
  first.render(21, kForever);
  Renderer second(scene(), GetParam());
  restoreFrom(second, stateOf(first));
  second.render(90, kForever);
  EXPECT_EQ(second.film().sums(), whole.sums());
  EXPECT_EQ(second.film().ranges(), whole.ranges());
}

TEST_P(ReproducibleTest, RangesMergeExactly) {
  const Film whole = rendered(scene(), 90, GetParam());
  Film merged(whole.format());
  for (const auto& [begin, end] : SampleRanges{{71, 90}, {0, 5}, {5, 71}}) {
    Renderer renderer(scene(), GetParam(), begin);
    renderer.render(end, kForever);
    mergeFilm(merged, renderer.film(), "part");
  }
  EXPECT_EQ(merged.sums(), whole.sums());
  EXPECT_EQ(merged.ranges(), whole.ranges());
  EXPECT_NE(spectral::errorOf([&] { mergeFilm(merged, whole, "part"); }).find("overlap"), std::string::npos);
}

TEST_P(ReproducibleTest, AnotherSeedIsAnotherPicture) {
  RenderOptions other = GetParam();
  other.seed = 1;
  EXPECT_NE(rendered(scene(), 4, GetParam()).sums(), rendered(scene(), 4, other).sums());
}

INSTANTIATE_TEST_SUITE_P(Integrators, ReproducibleTest,
                         testing::Values(RenderOptions{}, RenderOptions{0, true, Restir::Off},
                                         RenderOptions{0, false, Restir::Hero}, RenderOptions{0, true, Restir::Lanes}));

/// Lamps about a corner: more than a few, so that each surface chooses among them by its place.
const Scene& lampsInACorner() {
  static const Scene scene = [] {
    std::string text =
        "metamer_scene: 1\n"
        "film: {width: 24, height: 16}\n"
        "camera: {origin: [0, 1, 5], target: [0, 1, 0], up: [0, 1, 0], fov_x: 50}\n"
        "integrator: {max_depth: 5, russian_roulette: 3, wavelengths: 4}\n"
        "shapes:\n"
        "  - rectangle: {center: [0, 0, 0], half_u: [2, 0, 0], half_v: [0, 0, -2]}\n    diffuse: 0.7\n"
        "  - rectangle: {center: [0, 2, -1], half_u: [2, 0, 0], half_v: [0, 2, 0]}\n    diffuse: 0.7\n"
        "lights:\n";
    for (int i = 0; i < 9; ++i) {
      text += "  - point: {position: [" + std::to_string(0.4 * i - 1.6) + ", " + std::to_string(0.3 + 0.2 * (i % 4)) +
              ", " + std::to_string(0.2 * (i % 3)) + "], intensity: 1}\n";
    }
    return sceneOf(text);
  }();
  return scene;
}

TEST(LightChoiceTest, NeitherThreadsNorRangesChangeABit) {
  for (const RenderOptions& options : {RenderOptions{}, RenderOptions{0, true, Restir::Lanes}}) {
    const Film whole = rendered(lampsInACorner(), 40, options, 1);
    EXPECT_EQ(rendered(lampsInACorner(), 40, options, 3).sums(), whole.sums());
    Film merged(whole.format());
    for (const auto& [begin, end] : SampleRanges{{23, 40}, {0, 23}}) {
      Renderer renderer(lampsInACorner(), options, begin);
      renderer.render(end, kForever);
      mergeFilm(merged, renderer.film(), "part");
    }
    EXPECT_EQ(merged.sums(), whole.sums());
  }
}

/// A lamp that fills the picture, far brighter than what it gives where the camera looks to: sums of its pixels outgrow
/// what was expected of them.
const Scene& lampCloseBy() {
  static const Scene scene = sceneOf(
      "metamer_scene: 1\n"
      "film: {width: 37, height: 11, bins: {from: 400, to: 700, step: 100}}\n"
      "camera: {origin: [0, 0, 0.1], target: [0, 0, -1000], up: [0, 1, 0], fov_x: 5}\n"
      "shapes:\n  - sphere: {center: [0, 0, 0], radius: 0.01}\n    emission: 1\n");
  return scene;
}

bool hasCarries(const Film& film) {
  const auto& carries = film.sums().carries();
  return std::any_of(carries.begin(), carries.end(), [](const auto& segment) { return !segment.empty(); });
}

TEST(BrightFilmTest, SumsBeyondTheirWordsMergeAndGoOnBitByBit) {
  const Film whole = rendered(lampCloseBy(), 30, {}, 1);
  ASSERT_TRUE(hasCarries(whole));
  EXPECT_FALSE(hasCarries(rendered(scene(), 30)));  // as pictures mostly are
  for (std::size_t pixel = 0; pixel < whole.format().pixels(); ++pixel) {
    ASSERT_NEAR(whole.luminance(pixel).mean, 1.0, 0.05);  // 120 wavelengths: noise of one in a hundred
  }
  EXPECT_EQ(rendered(lampCloseBy(), 30, {}, 3).sums(), whole.sums());
  Film merged(whole.format());
  for (const auto& [begin, end] : SampleRanges{{23, 30}, {0, 23}}) {
    Renderer renderer(lampCloseBy(), {}, begin);
    renderer.render(end, kForever);
    // By way of a file and of a checkpoint.
    const std::filesystem::path file = scratchFile("bright.exr");
    writeExr(renderer.film(), {}, file, true, false);
    mergeFilm(merged, readExrState(file).first, "part");
    Renderer again(lampCloseBy(), {}, begin);
    restoreFrom(again, stateOf(renderer));
    EXPECT_EQ(again.film().sums(), renderer.film().sums());
  }
  EXPECT_EQ(merged.sums(), whole.sums());
}

TEST(LightChoiceTest, ByPlaceIsQuieterAndAFewLightsAreChosenByPower) {
  const RenderOptions byPower{0, false, Restir::Off, LightRule::Power};
  EXPECT_EQ(rendered(scene(), 4).sums(), rendered(scene(), 4, byPower).sums());
  const AreaMean place = luminanceOver(rendered(lampsInACorner(), 256), 0, 0, 24, 16);
  const AreaMean power = luminanceOver(rendered(lampsInACorner(), 256, byPower), 0, 0, 24, 16);
  EXPECT_LT(place.error, 0.7 * power.error);
  EXPECT_LT(std::abs(place.mean - power.mean), 5.0 * std::hypot(place.error, power.error));
}

}  // namespace
}  // namespace metamer::spectral_ref
