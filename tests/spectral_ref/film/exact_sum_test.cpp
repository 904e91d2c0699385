// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral_ref/exact_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace metamer::spectral_ref {
namespace {

TEST(ExactSumTest, DoesNotDependOnTheOrder) {
  std::mt19937 random(7);
  std::lognormal_distribution<double> size(0.0, 12.0);
  std::vector<double> terms(5000);
  for (double& term : terms) {
    term = std::min(size(random), 1e11) * (random() % 3 == 0 ? -1 : 1);
  }
  ExactSum forward;
  for (const double term : terms) {
    forward.add(term);
  }
  std::shuffle(terms.begin(), terms.end(), random);
  ExactSum halves[2];
  for (std::size_t i = 0; i < terms.size(); ++i) {
    halves[i % 2].add(terms[i]);
  }
  halves[0].add(halves[1]);
  EXPECT_EQ(forward, halves[0]);
  double plain = 0;
  for (const double term : terms) {
    plain += term;
  }
  // Doubles lose a few of their last bits on the way.
  EXPECT_NEAR(forward.value(), plain, std::abs(plain) * 1e-12);
}

TEST(ExactSumTest, IsExactDownToItsLastBit) {
  ExactSum sum;
  sum.add(1e12);
  sum.add(0x1p-64);
  sum.add(-1e12);
  EXPECT_EQ(sum.value(), 0x1p-64);
  sum.add(-0x1p-63);
  EXPECT_EQ(sum.value(), -0x1p-64);
}

TEST(ExactSumTest, ATermIsCutOffBelowTheLastBit) {
  std::mt19937_64 random(9);
  for (int exponent = -70; exponent < 40; ++exponent) {
    for (int i = 0; i < 100; ++i) {
      const double size = std::ldexp(1.0 + static_cast<double>(random() >> 12U) * 0x1p-52, exponent);
      const double whole = std::floor(size);
      const ExactSum expected{static_cast<std::uint64_t>((size - whole) * 0x1p64), static_cast<std::int64_t>(whole)};
      ASSERT_EQ(ExactSum::of(size), expected) << size;
      ASSERT_EQ(ExactSum::of(-size), -expected) << size;
    }
  }
  EXPECT_EQ(ExactSum::of(0.0), ExactSum{});
  EXPECT_EQ(ExactSum::of(-0.0), ExactSum{});
}

}  // namespace
}  // namespace metamer::spectral_ref
