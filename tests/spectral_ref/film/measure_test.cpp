// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral_ref/measure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "metamer/spectral_ref/exr_film.h"
#include "spectral/temporary_folder.h"
#include "spectral_ref/scene_fixture.h"

namespace metamer::spectral_ref {
namespace {

TEST(StudentQuantileTest, AgreesWithTables) {
  // Any table of the t distribution.
  EXPECT_NEAR(studentQuantile(0.975, 1), 12.7062, 1e-3);
  EXPECT_NEAR(studentQuantile(0.975, 3), 3.18245, 1e-5);
  EXPECT_NEAR(studentQuantile(0.975, 30), 2.04227, 1e-5);
  EXPECT_NEAR(studentQuantile(0.975, 1e6), 1.95996, 1e-4);
}

TEST(MeasureTest, MeansAndIntervalsOfTheFile) {
  const Scene scene = sceneOf(
      "metamer_scene: 1\n"
      "film: {width: 12, height: 8, bins: {from: 400, to: 700, step: 100}}\n"
      "lights: [{environment: {emission: D65}}]\n");
  const Film film = rendered(scene, 32);
  const std::filesystem::path file = scratchFile("measure.exr");
  writeExr(film, {}, file, false, false);
  const Measurement measurement = measure(file, {{"part", 2, 1, 5, 4}});
  const AreaMean expected = luminanceOver(film, 2, 1, 5, 4);
  ASSERT_EQ(measurement.patches.size(), 1U);
  const PatchMean& patch = measurement.patches.front();
  // Through float32.
  EXPECT_NEAR(patch.luminance, expected.mean, 1e-6 * expected.mean);
  EXPECT_NEAR(patch.colour[1], expected.mean, 1e-6 * expected.mean);
  EXPECT_NEAR(std::sqrt(patch.variance), expected.error, 1e-5 * expected.error);
  EXPECT_NEAR(patch.halfWidth, 2.0 * expected.error, 0.2 * expected.error);
  EXPECT_EQ(measurement.wavelengthsNm, (std::vector<double>{400, 500, 600, 700}));
  EXPECT_EQ(patch.bins.size(), 4U);
  EXPECT_NE(spectral::errorOf([&] { measure(file, {{"part", 9, 1, 5, 4}}); }).find("outside"), std::string::npos);
  EXPECT_NE(spectral::errorOf([&] { measure("none.exr", {}); }).find("cannot be read"), std::string::npos);
}

TEST(MeasureTest, ExactSumsComeBackFromTheFile) {
  const Scene scene = sceneOf(chartScene(4, "A", 20, 13));
  const Film film = rendered(scene, 8);
  const std::filesystem::path file = scratchFile("state.exr");
  writeExr(film, {{"seed", "0"}}, file, true, false);
  const auto [again, notes] = readExrState(file);
  EXPECT_EQ(again.sums(), film.sums());
  EXPECT_EQ(again.ranges(), film.ranges());
  EXPECT_TRUE(again.format() == film.format());
  EXPECT_EQ(notes, (FilmNotes{{"seed", "0"}}));
  writeExr(film, {}, file, false, false);
  EXPECT_NE(spectral::errorOf([&] { readExrState(file); }).find("--samples"), std::string::npos);
}

}  // namespace
}  // namespace metamer::spectral_ref
