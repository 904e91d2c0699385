// SPDX-License-Identifier: Apache-2.0
#include "chain/signed_log.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "metamer/ocio/pixel_processor.h"

namespace metamer::ocio {
namespace {

TEST(SignedLogTest, CountsStopsOnEitherSide) {
  EXPECT_EQ(signedLog(0.0), 0.0);
  EXPECT_NEAR(signedLog(0.18), kChainStops + kSignedLogToe, 1e-12);
  EXPECT_NEAR(signedLog(0.36) - signedLog(0.18), 1.0, 1e-12);
  EXPECT_NEAR(signedLog(-0.36) - signedLog(-0.18), -1.0, 1e-12);
  for (double value = 1e-12; value < 1e7; value *= 1.7) {
    EXPECT_NEAR(signedExponential(signedLog(value)), value, 1e-12 * value);
    EXPECT_EQ(signedLog(-value), -signedLog(value));
    EXPECT_EQ(signedExponential(-signedLog(value)), -signedExponential(signedLog(value)));
  }
}

TEST(SignedLogTest, OcioWorksItOut) {
  const PixelProcessor forward(signedLogOfThird());
  const PixelProcessor back(signedExponentialOfAll());
  for (double size = 1e-11; size < 1e6; size *= 1.7) {
    for (const double value : {size, -size}) {
      std::array<float, 4> pixel = {0.25F, 1.5F, static_cast<float>(value), 0.5F};
      forward.apply(pixel);
      EXPECT_EQ(pixel[0], 0.25F);
      EXPECT_EQ(pixel[1], 1.5F);
      EXPECT_NEAR(pixel[2], 0.5 + 0.5 * signedLog(value) / kMostSignedLog, 3e-7) << value;
      EXPECT_EQ(pixel[3], 0.5F);
      const auto log = static_cast<float>(signedLog(value));
      std::array<float, 4> logs = {log, -log, log, 0.5F};
      back.apply(logs);
      const double rounding = 3e-5 * size;
      EXPECT_NEAR(logs[0], value, rounding);
      EXPECT_NEAR(logs[1], -value, rounding);
      EXPECT_NEAR(logs[2], value, rounding);
    }
  }
}

}  // namespace
}  // namespace metamer::ocio
