// SPDX-License-Identifier: Apache-2.0
#include "map/fused_in_double.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace metamer::sip {
namespace {

TEST(FusedInDoubleTest, IsTheFusedOperationUnlessItSaysSo) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> mantissa(-2.0F, 2.0F);
  std::uniform_int_distribution<int> exponent(-60, 40);
  int apart = 0;
  for (int i = 0; i < 100000; ++i) {
    const float a = std::ldexp(mantissa(random), exponent(random));
    const float b = std::ldexp(mantissa(random), exponent(random));
    const float c = std::ldexp(mantissa(random), exponent(random));
    bool isRoundedOnce = true;
    const float result = fusedInDouble(a, b, c, isRoundedOnce);
    if (isRoundedOnce) {
      EXPECT_EQ(result, std::fma(a, b, c)) << a << " " << b << " " << c;
    } else {
      ++apart;
    }
  }
  EXPECT_LT(apart, 10);
}

TEST(FusedInDoubleTest, SaysWhereTwoRoundingsAreNotOne) {
  // The product lies half way between two floats; what decides is lost in double.
  const float a = 1.0F + 0x1p-12F;
  bool isRoundedOnce = true;
  EXPECT_NE(fusedInDouble(a, a, 0x1p-80F, isRoundedOnce), std::fma(a, a, 0x1p-80F));
  EXPECT_FALSE(isRoundedOnce);
  // Under the normal floats the half way lies elsewhere.
  isRoundedOnce = true;
  fusedInDouble(0x1.000002p-70F, 0x1p-70F, 0.0F, isRoundedOnce);
  EXPECT_FALSE(isRoundedOnce);
}

TEST(FusedInDoubleTest, ZeroAndTheSmallestNormalAreRoundedOnce) {
  bool isRoundedOnce = true;
  EXPECT_EQ(fusedInDouble(-2.0F, 1.0F, 2.0F, isRoundedOnce), 0.0F);
  EXPECT_EQ(fusedInDouble(std::numeric_limits<float>::min(), 1.0F, 0.0F, isRoundedOnce),
            std::numeric_limits<float>::min());
  EXPECT_TRUE(isRoundedOnce);
}

}  // namespace
}  // namespace metamer::sip
