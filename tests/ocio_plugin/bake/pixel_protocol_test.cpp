// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/pixel_protocol.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sip/sip_fixture.h"
#include "spectral/fixture.h"

namespace metamer::ocio {
namespace {

class PixelProtocolTest : public testing::Test {
 protected:
  sip::SpectralTransform m_engine{sip::naturalSpecOf("D65", "A"), 81};
  PixelProtocol m_protocol{m_engine, spectral::testLibrary().certificatePixels()};

  /// The engine with one pixel changed.
  PixelProtocol::Report withChanged(std::size_t pixel, const Eigen::Vector3f& by) const {
    return m_protocol.measure([&](std::span<float> rgba) {
      m_engine.apply(rgba);
      Eigen::Map<Eigen::Vector3f>(rgba.data() + 4 * pixel) += by;
    });
  }
};

TEST_F(PixelProtocolTest, TheEngineIsOffByNothing) {
  const auto report = m_protocol.measure([&](std::span<float> rgba) { m_engine.apply(rgba); });
  EXPECT_EQ(report.count, 4096U);
  EXPECT_LE(report.largest, 1e-6);
  EXPECT_LE(report.noisyCodes, 1e-3);
}

TEST_F(PixelProtocolTest, ASparkleInTheDarkCountsInFull) {
  const auto pixels = spectral::testLibrary().certificatePixels();
  std::size_t darkest = 0;
  for (std::size_t k = 0; k < pixels.size(); ++k) {
    const double size = pixels[k].rgb.cwiseAbs().maxCoeff();
    darkest = size > 1e-4 && size < pixels[darkest].rgb.cwiseAbs().maxCoeff() ? k : darkest;
  }
  const double size = pixels[darkest].rgb.cwiseAbs().maxCoeff();
  const auto report = withChanged(darkest, {0.0F, static_cast<float>(2.0 * size), 0.0F});
  EXPECT_NEAR(report.largest, 2.0, 0.01);
  EXPECT_EQ(report.worstKind, pixels[darkest].kind);
  EXPECT_LE((report.worstRgb - pixels[darkest].rgb).cwiseAbs().maxCoeff(), 1e-6);
}

TEST_F(PixelProtocolTest, WhatIsNoNumberIsInfinitelyFarOff) {
  const auto report = withChanged(7, {std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F});
  EXPECT_EQ(report.largest, std::numeric_limits<double>::infinity());
}

TEST_F(PixelProtocolTest, CodesAreADisplays) {
  // All a twentieth brighter: in the curve's power part a code grows by 1.05^(1/2.4), of 255 at most.
  const auto report = m_protocol.measure([&](std::span<float> rgba) {
    m_engine.apply(rgba);
    for (float& value : rgba) {
      value *= 1.05F;
    }
  });
  EXPECT_GT(report.photographCodes, 3.0);
  EXPECT_LT(report.photographCodes, 270.0 * (std::pow(1.05, 1.0 / 2.4) - 1.0));
}

TEST_F(PixelProtocolTest, BrighteningIsTheEnginesOwn) {
  // Red light is what a tungsten lamp has more of.
  EXPECT_GT(m_protocol.brightening(), 1.0);
  const sip::SpectralTransform same(sip::naturalSpecOf("D65", "D65"), 81);
  EXPECT_NEAR(PixelProtocol(same, spectral::testLibrary().certificatePixels()).brightening(), 1.0, 1e-6);
}

}  // namespace
}  // namespace metamer::ocio
