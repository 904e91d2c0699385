// SPDX-License-Identifier: Apache-2.0
#include "pixels/signal_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace metamer::ofx {
namespace {

float decoded(const SignalTable& table, float signal) {
  std::vector<float> pixel = {signal, signal, signal, 0.5F};
  table.decode(pixel);
  EXPECT_EQ(pixel[3], 0.5F);
  return pixel[0];
}

float encoded(const SignalTable& table, float light) {
  std::vector<float> pixel = {light, light, light, 0.5F};
  table.encode(pixel);
  EXPECT_EQ(pixel[3], 0.5F);
  return pixel[0];
}

// The header's promise, 3e-8, and half a float's last bit, 6e-8; of a hundredth of white, for less light, and of a
// tenth of the range, for less signal.
constexpr double kTolerance = 9.1e-8;

TEST(SignalTable, DecodesAsTheCurveDoes) {
  for (const spectral::LogEncoding encoding : spectral::allLogEncodings()) {
    const SignalTable table(encoding);
    double worst = 0;
    for (int i = -80000; i <= 200000; ++i) {
      const float signal = static_cast<float>(i) * 1.00001e-5F;
      const double light = spectral::decode(encoding, signal);
      worst = std::max(worst, std::abs(decoded(table, signal) - light) / std::max(std::abs(light), 0.01));
    }
    EXPECT_LT(worst, kTolerance) << spectral::nameOf(encoding);
  }
}

TEST(SignalTable, EncodesAsTheCurveDoes) {
  for (const spectral::LogEncoding encoding : spectral::allLogEncodings()) {
    const SignalTable table(encoding);
    double worst = 0;
    for (const float sign : {1.0F, -1.0F}) {
      for (int i = 0; i < 100000; ++i) {
        // Over more octaves than the table holds; -4 % of grey, as far as noise goes, and beyond.
        const float light = sign * std::exp2(-25.0F + 50.0F * static_cast<float>(i) / 100000);
        const double signal = spectral::encode(encoding, light);
        worst = std::max(worst, std::abs(encoded(table, light) - signal) / std::max(std::abs(signal), 0.1));
      }
    }
    EXPECT_LT(worst, kTolerance) << spectral::nameOf(encoding);
  }
}

TEST(SignalTable, WhatIsNoNumberAndWhatIsZero) {
  const SignalTable table(spectral::LogEncoding::AcesCct);
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(std::isnan(decoded(table, std::numeric_limits<float>::quiet_NaN())));
  EXPECT_TRUE(std::isnan(encoded(table, std::numeric_limits<float>::quiet_NaN())));
  EXPECT_EQ(encoded(table, infinity), static_cast<float>(spectral::encode(spectral::LogEncoding::AcesCct, infinity)));
  for (const float zero : {0.0F, -0.0F, 1e-41F, -1e-41F}) {
    EXPECT_EQ(encoded(table, zero), static_cast<float>(spectral::encode(spectral::LogEncoding::AcesCct, 0.0)));
  }
}

}  // namespace
}  // namespace metamer::ofx
