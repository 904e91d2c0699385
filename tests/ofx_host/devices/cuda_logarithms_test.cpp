// SPDX-License-Identifier: Apache-2.0
// The kernels' own logarithm and power of ten beside those of the C library.
#include <cuda_words.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace cuda_window {
#include "window.cu"
}  // namespace cuda_window

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// In units of the last place of what is right.
double unitsOff(double given, double right) {
  return std::abs(given - right) / (std::nextafter(std::abs(right), kInfinity) - std::abs(right));
}

TEST(OfxCudaLogarithms, AreOffByAFewUnitsInTheLastPlace) {
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> exponents(-1070.0, 1020.0);
  std::uniform_real_distribution<double> nearOne(0.5, 2.0);
  std::uniform_real_distribution<double> tens(-300.0, 300.0);
  std::uniform_real_distribution<double> fewTens(-6.0, 6.0);
  double logarithm = 0.0;
  double power = 0.0;
  for (int k = 0; k < 500'000; ++k) {
    for (const double x : {std::exp2(exponents(generator)), nearOne(generator)}) {
      logarithm = std::max(logarithm, unitsOff(cuda_window::metamerLog10(x), std::log10(x)));
    }
    for (const double y : {tens(generator), fewTens(generator)}) {
      power = std::max(power, unitsOff(cuda_window::metamerPowerOfTen(y), std::pow(10.0, y)));
    }
  }
  std::printf("[ device ] logarithms off by %.1f units in a double's last place, powers by %.1f\n", logarithm, power);
  // A float's last place is 5e8 of them.
  EXPECT_LE(logarithm, 6.0);
  EXPECT_LE(power, 4.0);
}

TEST(OfxCudaLogarithms, HaveTheEndsThatOthersHave) {
  using cuda_window::metamerLog10;
  using cuda_window::metamerPowerOfTen;
  EXPECT_EQ(metamerLog10(1.0), 0.0);
  EXPECT_EQ(metamerLog10(0.0), -kInfinity);
  EXPECT_EQ(metamerLog10(kInfinity), kInfinity);
  EXPECT_TRUE(std::isnan(metamerLog10(-1.0)));
  EXPECT_TRUE(std::isnan(metamerLog10(std::nan(""))));
  EXPECT_EQ(metamerPowerOfTen(0.0), 1.0);
  EXPECT_EQ(metamerPowerOfTen(400.0), kInfinity);
  EXPECT_EQ(metamerPowerOfTen(308.5), kInfinity);
  EXPECT_EQ(metamerPowerOfTen(kInfinity), kInfinity);
  EXPECT_EQ(metamerPowerOfTen(-kInfinity), 0.0);
  EXPECT_EQ(metamerPowerOfTen(-400.0), 0.0);
  EXPECT_NEAR(metamerPowerOfTen(-320.0), 1e-320, 1e-322);
  EXPECT_TRUE(std::isnan(metamerPowerOfTen(std::nan(""))));
}

}  // namespace
