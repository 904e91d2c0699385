// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/shaper.h"

#include <gtest/gtest.h>

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

std::vector<float> through(OCIO::TransformDirection direction, const std::vector<float>& values) {
  std::vector<float> rgba;
  for (const float value : values) {
    rgba.insert(rgba.end(), {value, value, value, 1.0F});
  }
  PixelProcessor(shaperTransform(ShaperTest::GetParam(), direction)).apply(rgba);
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
  const std::vector<float> out = through(OCIO::TRANSFORM_DIR_FORWARD, in);
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
  const std::vector<float> out = through(OCIO::TRANSFORM_DIR_INVERSE, in);
  for (std::size_t k = 0; k < in.size(); ++k) {
    const double expected = spectral::decode(GetParam(), static_cast<double>(in[k]));
    EXPECT_NEAR(out[k], expected, 2e-7 + 2e-5 * std::abs(expected)) << "at " << in[k];
  }
}

TEST_P(ShaperTest, IsFoundByItsName) {
  EXPECT_EQ(shaperFromName(spectral::nameOf(GetParam())), GetParam());
}

INSTANTIATE_TEST_SUITE_P(All, ShaperTest, testing::ValuesIn(spectral::allLogEncodings()),
                         [](const auto& instance) { return "Curve" + std::to_string(instance.index); });

TEST(ShaperNameTest, UnknownNamesListTheCurves) {
  EXPECT_EQ(shaperFromName("acescct"), spectral::LogEncoding::AcesCct);
  const std::string error = spectral::errorOf([] { shaperFromName("log9"); });
  EXPECT_NE(error.find("shaper 'log9'"), std::string::npos) << error;
  EXPECT_NE(error.find("ACEScct, LogC3"), std::string::npos) << error;
}

}  // namespace
}  // namespace metamer::ocio
