// SPDX-License-Identifier: Apache-2.0
#include "pixels/pixel_format.h"

#include <gtest/gtest.h>
#include <ofxCore.h>
#include <ofxImageEffect.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "ofx_host/half_float.h"

namespace metamer::ofx {
namespace {

TEST(PixelFormat, EveryCodeComesBack) {
  for (const Depth depth : {Depth::Byte, Depth::Short, Depth::Half}) {
    for (int code = 0; code < (depth == Depth::Byte ? 256 : 65536); ++code) {
      const auto wide = static_cast<std::uint16_t>(code);
      if (depth == Depth::Half && !std::isfinite(photo_host::floatFromHalf(wide))) {
        continue;
      }
      std::array<unsigned char, 2> bytes{};
      std::memcpy(bytes.data(), &wide, 2);
      std::array<float, 4> rgba{};
      const PixelFormat format{depth, Components::Alpha};
      readPixels(format, bytes.data(), 1, rgba.data());
      if (depth == Depth::Half) {
        ASSERT_EQ(rgba[3], photo_host::floatFromHalf(wide));
      }
      std::array<unsigned char, 2> written{};
      writePixels(format, rgba.data(), 1, written.data());
      ASSERT_EQ(std::memcmp(written.data(), bytes.data(), format.bytesPerPixel()), 0) << code;
    }
  }
}

TEST(PixelFormat, IntegersRoundAndClampAndTakeNoNumberForBlack) {
  const PixelFormat bytes{Depth::Byte, Components::Rgba};
  const std::array<float, 4> rgba = {1.5F, -0.1F, std::numeric_limits<float>::quiet_NaN(), 0.5F};
  std::array<unsigned char, 4> codes{};
  writePixels(bytes, rgba.data(), 1, codes.data());
  EXPECT_EQ(codes, (std::array<unsigned char, 4>{255, 0, 0, 128}));
}

TEST(PixelFormat, KnowsTheNamesOfHostsAndNoOthers) {
  EXPECT_EQ(pixelFormat(kOfxBitDepthHalf, kOfxImageComponentRGB), (PixelFormat{Depth::Half, Components::Rgb}));
  EXPECT_EQ(pixelFormat(kOfxBitDepthFloat, kOfxImageComponentRGBA)->bytesPerPixel(), 16U);
  EXPECT_FALSE(pixelFormat(kOfxBitDepthNone, kOfxImageComponentRGBA));
  EXPECT_FALSE(pixelFormat(kOfxBitDepthByte, "OfxImageComponentMotionVectors"));
}

}  // namespace
}  // namespace metamer::ofx
