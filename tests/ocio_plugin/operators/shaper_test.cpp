// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/shaper.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "metamer/ocio/pixel_processor.h"
#include "spectral/fixture.h"

namespace metamer::ocio {
namespace {

class ShaperTest : public testing::TestWithParam<spectral::LogEncoding> {};

/// Light from far below zero to the largest half, dense around the toes.
std::vector<float> lights() {
  std::vector<float> values;
  for (float x = -0.05F; x < 0.05F; x += 1e-4F) {
    values.push_back(x);
  }
  for (float x = 1e-6F; x < 60000.0F; x *= 1.01F) {
    values.push_back(x);
  }
  return values;
}

std::vector<float> through(const Shaper& shaper, OCIO::TransformDirection direction, const std::vector<float>& values) {
  std::vector<float> rgba;
  for (const float value : values) {
    rgba.insert(rgba.end(), {value, value, value, 1.0F});
  }
  PixelProcessor(shaperTransform(shaper, direction)).apply(rgba);
  std::vector<float> result;
  for (std::size_t k = 0; k < rgba.size(); k += 4) {
    EXPECT_EQ(rgba[k], rgba[k + 1]);
    EXPECT_EQ(rgba[k], rgba[k + 2]);
    result.push_back(rgba[k]);
  }
  return result;
}

// Float logarithms err by a few units in the last place of numbers up to 16; the half-domain tables of the Canon curves
// by less than 1e-6 of their signal.
TEST_P(ShaperTest, ForwardIsEncode) {
  const std::vector<float> in = lights();
  const std::vector<float> out = through(GetParam(), OCIO::TRANSFORM_DIR_FORWARD, in);
  for (std::size_t k = 0; k < in.size(); ++k) {
    EXPECT_NEAR(out[k], spectral::encode(GetParam(), static_cast<double>(in[k])), 3e-6) << "at " << in[k];
  }
}

// A signal error of 1e-7 is 2e-6 of the light on the flattest curve; the tables' own is below 1e-5.
TEST_P(ShaperTest, InverseIsDecode) {
  std::vector<float> in;
  for (int k = -200; k <= 4200; ++k) {
    in.push_back(static_cast<float>(k) / 4000.0F);
  }
  const std::vector<float> out = through(GetParam(), OCIO::TRANSFORM_DIR_INVERSE, in);
  for (std::size_t k = 0; k < in.size(); ++k) {
    const double expected = spectral::decode(GetParam(), static_cast<double>(in[k]));
    EXPECT_NEAR(out[k], expected, 2e-7 + 2e-5 * std::abs(expected)) << "at " << in[k];
  }
}

TEST_P(ShaperTest, IsFoundByItsName) {
  EXPECT_EQ(shaperFromName(spectral::nameOf(GetParam())), Shaper(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(All, ShaperTest, testing::ValuesIn(spectral::allLogEncodings()),
                         [](const auto& instance) { return "Curve" + std::to_string(instance.index); });

TEST(ShaperNameTest, UnknownNamesListTheCurves) {
  EXPECT_EQ(shaperFromName("acescct"), Shaper(spectral::LogEncoding::AcesCct));
  const std::string error = spectral::errorOf([] { shaperFromName("log9"); });
  EXPECT_NE(error.find("shaper 'log9'"), std::string::npos) << error;
  EXPECT_NE(error.find("ACEScct, LogC3"), std::string::npos) << error;
}

TEST(DisplayShaperTest, CurvesAreTheirStandards) {
  struct Case {
    const char* name;
    const char* said;
    double signal;
    double light;
  };
  // IEC 61966-2-1 at a middle code, ITU-R BT.1886 with a black of no light, and powers.
  const std::array cases = {Case{"srgb", "sRGB", 0.5, 0.21404114}, Case{"BT.1886", "Rec.1886", 0.5, 0.18946457},
                            Case{"gamma 2.2", "Gamma 2.2", 0.5, 0.21763764},
                            Case{"Gamma 2.6", "Gamma 2.6", 0.25, 0.02720470}};
  for (const Case& one : cases) {
    const Shaper shaper = shaperFromName(one.name);
    EXPECT_EQ(nameOf(shaper), one.said);
    EXPECT_TRUE(isDisplay(shaper));
    EXPECT_NEAR(decode(shaper, one.signal), one.light, 1e-8);
    const auto signal = static_cast<float>(one.signal);
    const auto light = static_cast<float>(one.light);
    // OCIO's sRGB joins its line and power where they meet, the standard where it rounded the place: 1e-6 of white.
    EXPECT_NEAR(through(shaper, OCIO::TRANSFORM_DIR_INVERSE, {signal})[0], one.light, 1e-6);
    EXPECT_NEAR(through(shaper, OCIO::TRANSFORM_DIR_FORWARD, {light})[0], one.signal, 1e-6);
    EXPECT_NEAR(through(shaper, OCIO::TRANSFORM_DIR_FORWARD, {-light})[0], -one.signal, 1e-6);
    EXPECT_NEAR(through(shaper, OCIO::TRANSFORM_DIR_INVERSE, {1.5F})[0], decode(shaper, 1.5), 1e-5);
  }
  EXPECT_NE(spectral::errorOf([] { shaperFromName("Gamma 0.5"); }).find("1 to 4"), std::string::npos);
}

}  // namespace
}  // namespace metamer::ocio
