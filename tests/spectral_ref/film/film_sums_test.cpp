// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral_ref/film_sums.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace metamer::spectral_ref {
namespace {

constexpr std::size_t kChannels = 3;
constexpr int kWidth = 37;  // no whole number of segments
constexpr int kHeight = 2;
constexpr int kPixels = kWidth * kHeight;

struct Term {
  std::size_t pixel;
  std::size_t channel;
  double value;
};

/// Of all sizes, from below the unit to far beyond 64 bits of it.
std::vector<Term> terms(int unitExponent) {
  std::mt19937_64 random(7);
  std::vector<Term> result(20000);
  for (Term& term : result) {
    const int exponent = unitExponent - 4 + static_cast<int>(random() % 104);
    const double size = std::ldexp(1.0 + static_cast<double>(random() >> 12U) * 0x1p-52, exponent);
    term = {random() % kPixels, random() % kChannels, random() % 3 == 0 ? -size : size};
  }
  return result;
}

bool areEqual(const FilmSums& a, const FilmSums& b) {
  return a == b;
}

TEST(FilmSumsTest, NeitherOrderNorGroupingMatters) {
  for (const int exponent : {-68, -44, 3}) {
    std::vector<Term> all = terms(exponent);
    FilmSums forward(kWidth, kHeight, kChannels, exponent);
    // 128 bits hold these sums: what they come to by the sum that keeps them all.
    std::vector<ExactSum> expected(kPixels * kChannels);
    for (const Term& term : all) {
      forward.add(term.pixel, term.channel, term.value);
      const double units = std::nearbyint(std::ldexp(term.value, -exponent));
      expected[term.pixel * kChannels + term.channel].add(std::ldexp(units, -64));
    }
    std::mt19937 random(5);
    std::shuffle(all.begin(), all.end(), random);
    std::vector<FilmSums> parts(3, FilmSums(kWidth, kHeight, kChannels, exponent));
    for (std::size_t i = 0; i < all.size(); ++i) {
      parts[i % 3].add(all[i].pixel, all[i].channel, all[i].value);
    }
    parts[0].add(parts[1]);
    parts[0].add(parts[2]);
    EXPECT_TRUE(areEqual(forward, parts[0]));
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_EQ(forward.sum(i / kChannels, i % kChannels), expected[i]);
      EXPECT_EQ(forward.value(i / kChannels, i % kChannels), std::ldexp(expected[i].value(), exponent + 64));
    }
    // And they come back from where they were written.
    FilmSums again(kWidth, kHeight, kChannels, exponent);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      again.set(i / kChannels, i % kChannels, expected[i]);
    }
    EXPECT_TRUE(areEqual(forward, again));
  }
}

TEST(FilmSumsTest, OnlyASegmentWhoseSumOutgrowsItsWordTakesMore) {
  FilmSums sums(kWidth, kHeight, kChannels, 0);
  const auto segmentsWithCarries = [&] {
    return std::count_if(sums.carries().begin(), sums.carries().end(), [](const auto& of) { return !of.empty(); });
  };
  const auto add = [&](double value) { sums.add(kWidth + 20, 1, value); };
  for (const double value : {0x1p61, 0x1p61, 0x1p61, 0x1.8p60}) {
    add(value);
  }
  EXPECT_EQ(segmentsWithCarries(), 0);
  add(0x1p61);
  EXPECT_EQ(segmentsWithCarries(), 1);
  EXPECT_EQ(sums.carries()[4].size(), sums.sumsASegment());  // three segments a row
  EXPECT_EQ(sums.value(kWidth + 20, 1), 4 * 0x1p61 + 0x1.8p60);
  EXPECT_EQ(sums.value(kWidth + 20, 0), 0.0);
  // Room that is no longer needed makes no difference.
  for (const double value : {-0x1p61, -0x1p61, -0x1p61, -0x1p61, -0x1.8p60}) {
    add(value);
  }
  EXPECT_TRUE(areEqual(sums, FilmSums(kWidth, kHeight, kChannels, 0)));
  add(1);
  EXPECT_FALSE(areEqual(sums, FilmSums(kWidth, kHeight, kChannels, 0)));
}

TEST(FilmSumsTest, TermsAreRoundedToTheNearestUnit) {
  FilmSums sums(1, 1, 1, -3);
  for (int i = 0; i < 8; ++i) {
    sums.add(0, 0, 0.07);  // 0.56 of a unit
  }
  EXPECT_EQ(sums.value(0, 0), 1.0);
  sums.add(0, 0, -0.06);
  EXPECT_EQ(sums.value(0, 0), 1.0);
}

}  // namespace
}  // namespace metamer::spectral_ref
