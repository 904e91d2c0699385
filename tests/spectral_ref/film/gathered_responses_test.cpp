// SPDX-License-Identifier: Apache-2.0
#include "film/gathered_responses.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace metamer::spectral_ref {
namespace {

Film filmOf(int unitExponent) {
  FilmFormat format;
  format.width = 1;
  format.height = 1;
  format.unitExponent = unitExponent;
  return Film(format);
}

/// Halves of a unit among them, which a rounding may take either way.
float randomTerm(std::mt19937& random, int unitExponent) {
  const int exponent = unitExponent - 3 + static_cast<int>(random() % 50);
  const auto halves = static_cast<float>(random() % 64);
  return std::ldexp(random() % 2 == 0 ? halves : -halves, exponent - 6);
}

TEST(GatheredResponsesTest, TheDetourChangesNoBit) {
  for (const int exponent : {-68, -44, 3}) {
    std::mt19937 random(3);
    Film straight = filmOf(exponent);
    Film film = filmOf(exponent);
    GatheredResponses gathered(film.sums().unitsInOne());
    for (std::uint64_t path = 0; path < GatheredResponses::kMostPaths; ++path) {
      const std::size_t replicate = random() % kReplicates;
      Eigen::Array4f response;
      for (float& term : response) {
        term = randomTerm(random, exponent);
      }
      ASSERT_TRUE(gathered.add(replicate, response));
      for (std::size_t c = 0; c < 3; ++c) {
        const auto term = static_cast<double>(response[static_cast<Eigen::Index>(c)]);
        straight.sums().add(0, Film::kColour + c, term);
        if (replicate % 2 == 1) {
          straight.sums().add(0, Film::kHalf + c, term);
        }
      }
      straight.sums().add(0, Film::kLuminance + replicate, static_cast<double>(response[3]));
    }
    gathered.addTo(film.sums(), 0);
    EXPECT_EQ(film.sums(), straight.sums()) << exponent;
  }
}

TEST(GatheredResponsesTest, TheLargestOfItsTermsFit) {
  Film film = filmOf(-44);
  GatheredResponses gathered(film.sums().unitsInOne());
  constexpr float kTerm = 0x1.fffffep4F;  // 2^49 units, less a little; four of them are 2^50 by root of squares
  for (std::uint64_t path = 0; path < GatheredResponses::kMostPaths; ++path) {
    ASSERT_TRUE(gathered.add(0, Eigen::Array4f::Constant(kTerm)));
  }
  gathered.addTo(film.sums(), 0);
  EXPECT_EQ(film.sums().value(0, Film::kLuminance),
            static_cast<double>(kTerm) * static_cast<double>(GatheredResponses::kMostPaths));
}

TEST(GatheredResponsesTest, TermsThatAreTooLargeAreLeftToTheFilm) {
  Film film = filmOf(-44);
  GatheredResponses gathered(film.sums().unitsInOne());
  for (const float bad :
       {0x1p6F, -0x1p6F, 1e20F, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    Eigen::Array4f response = Eigen::Array4f::Ones();
    response[2] = bad;
    EXPECT_FALSE(gathered.add(1, response)) << bad;
  }
  gathered.addTo(film.sums(), 0);
  EXPECT_EQ(film.sums(), filmOf(-44).sums());
}

}  // namespace
}  // namespace metamer::spectral_ref
