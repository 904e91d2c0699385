// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral_ref/film.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "film/film_sensor.h"
#include "spectral_ref/scene_fixture.h"
#include "wavelengths/wavelength_sampling.h"

namespace metamer::spectral_ref {
namespace {

TEST(ReplicatesTest, CountsWhatItDeals) {
  for (const std::uint64_t block : {1U, 3U, 16U}) {
    const Replicates replicates{block};
    std::array<std::uint64_t, kReplicates> counts{};
    for (std::uint64_t sample = 0; sample < 200; ++sample) {
      for (std::size_t g = 0; g < kReplicates; ++g) {
        EXPECT_EQ(replicates.countBelow(sample, g), counts[g]);
      }
      const std::size_t g = replicates.of(sample);
      EXPECT_EQ(replicates.index(sample), counts[g]);
      ++counts[g];
    }
  }
}

TEST(SampleRangesTest, JoinWhereTheyTouch) {
  SampleRanges ranges = {{0, 4}};
  EXPECT_TRUE(uniteRanges(ranges, {{8, 12}}));
  EXPECT_TRUE(uniteRanges(ranges, {{4, 8}}));
  EXPECT_EQ(ranges, (SampleRanges{{0, 12}}));
  EXPECT_FALSE(uniteRanges(ranges, {{11, 13}}));
  EXPECT_EQ(sampleCount(ranges), 12U);
}

TEST(FilmTest, TheVarianceIsHonest) {
  // Means of normal numbers: the estimated variance of the mean must agree with the true one, also where the
  // replicates have taken different numbers of samples.
  std::mt19937 random(3);
  std::normal_distribution<double> normal(5.0, 2.0);
  const std::array<std::uint64_t, kReplicates> counts = {7, 7, 6, 0};
  const double expected = 4.0 / 20.0;
  double sum = 0;
  constexpr int kTrials = 20000;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::array<double, kReplicates> sums{};
    for (std::size_t g = 0; g < kReplicates; ++g) {
      for (std::uint64_t i = 0; i < counts[g]; ++i) {
        sums[g] += normal(random);
      }
    }
    const Estimate estimate = Film::estimate(sums, counts);
    EXPECT_EQ(estimate.degrees, 2);
    sum += estimate.variance;
  }
  // Two degrees of freedom: one estimate spreads by its own size, the mean of 20000 by 0.7 %; four of those.
  EXPECT_NEAR(sum / kTrials, expected, 0.03 * expected);
}

TEST(FilmSensorTest, AFlatRadianceOfOneIsYOfOneAndOneInEveryBin) {
  const Scene scene = sceneOf("metamer_scene: 1\nfilm: {width: 1, height: 1, bins: {from: 380, to: 780, step: 25}}\n");
  FilmSensor sensor(scene.film);
  Film film(FilmFormat::of(scene.film, {}));
  GatheredResponses gathered(film.sums().unitsInOne());
  // Every half nanometre once: the sums are the integrals.
  constexpr int kSteps = 2 * kCells;
  for (int i = 0; i < kSteps; ++i) {
    const auto set = sampleWavelengths<1>(UniformWavelengths(), (static_cast<float>(i) + 0.5F) / kSteps);
    sensor.add<1>(film, gathered, 0, static_cast<std::size_t>(i) % kReplicates, set, Lanes<1>::Ones());
  }
  gathered.addTo(film.sums(), 0);
  film.setRanges({{0, kSteps}});
  EXPECT_NEAR(film.luminance(0).mean, 1.0, 1e-6);
  EXPECT_NEAR(film.colour(0).y(), 1.0, 1e-6);
  for (int bin = 0; bin < film.format().bins.count; ++bin) {
    EXPECT_NEAR(film.radiance(0, bin), 1.0, 1e-6) << bin;
  }
}

TEST(FilmSensorTest, WhatIsNoNumberIsLeftOutAndCounted) {
  const Scene scene = sceneOf("metamer_scene: 1\nfilm: {width: 1, height: 1}\n");
  FilmSensor sensor(scene.film);
  Film film(FilmFormat::of(scene.film, {}));
  GatheredResponses gathered(film.sums().unitsInOne());
  const auto set = sampleWavelengths<4>(UniformWavelengths(), 0.4F);
  for (const float bad : {NAN, INFINITY, 1e30F}) {
    Lanes<4> radiance = Lanes<4>::Ones();
    radiance[2] = bad;
    sensor.add<4>(film, gathered, 0, 0, set, radiance);
  }
  gathered.addTo(film.sums(), 0);
  EXPECT_EQ(sensor.refused(), 3U);
  EXPECT_EQ(film.sums(), Film(film.format()).sums());
}

}  // namespace
}  // namespace metamer::spectral_ref
