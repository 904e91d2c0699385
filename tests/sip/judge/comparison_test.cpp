// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sip/sip_fixture.h"

namespace metamer::sip {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

const spectral::RgbSpace& acescg() {
  static const spectral::RgbSpace space = testLibrary().colourSpace("ACEScg").linear;
  return space;
}

std::function<void(std::span<float>)> gain(float factor) {
  return [factor](std::span<float> rgba) {
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
      rgba[i] *= factor;
    }
  };
}

TEST(ComparisonTest, AgreesWithTheErrorProtocol) {
  const ErrorProtocol protocol(specOf("D65", "A"), chart(), {64, 16, -3, 4, false});
  const SpectralTransform coarse(specOf("D65", "A"), 16);
  const auto candidate = [&](std::span<float> rgba) { coarse.apply(rgba); };
  const ErrorProtocol::Report report = protocol.measure(candidate);
  const Comparison comparison = compareTransforms(
      acescg(), protocol.probes(), -3, 4, [&](std::span<float> rgba) { protocol.converged().apply(rgba); }, candidate);
  // What is expected goes through floats here: CIEDE2000 of 1e-7 of the light, 1e-4 at most.
  EXPECT_NEAR(comparison.mean, report.mean, 1e-4);
  EXPECT_NEAR(comparison.p99, report.p99, 1e-3);
  EXPECT_NEAR(comparison.max, report.max, 1e-3);
  ASSERT_EQ(comparison.colours.size(), report.count);
  EXPECT_EQ(comparison.colours[comparison.worst].deltaE, comparison.max);
}

TEST(ComparisonTest, OneGainIsTheSameAtEveryExposure) {
  const std::vector<ErrorProtocol::Probe> probes = {{"grey", Eigen::Vector3d::Constant(0.18)}};
  const Comparison comparison = compareTransforms(acescg(), probes, -12, 12, gain(1.0F), gain(1.05F));
  ASSERT_EQ(comparison.colours.size(), 25U);
  EXPECT_GT(comparison.max, 0.5);
  for (const ComparedColour& colour : comparison.colours) {
    EXPECT_NEAR(colour.deltaE, comparison.mean, 1e-4);
  }
}

TEST(ComparisonTest, PixelsAreWeighedByTheirOwnExposure) {
  // The same change of the same colour, bright and dark, and far below what counts.
  const std::vector<float> a = {8.0F, 8.0F, 8.0F, 1.0F, 0.01F, 0.01F, 0.01F, 1.0F, 1e-8F, 1e-8F, 1e-8F, 1.0F};
  std::vector<float> b = a;
  gain(1.1F)(b);
  const Comparison comparison = comparePixels(acescg(), a, b);
  EXPECT_NEAR(comparison.colours[0].deltaE, comparison.colours[1].deltaE, 1e-4);
  EXPECT_GT(comparison.colours[0].deltaE, 1.0);
  EXPECT_LT(comparison.colours[2].deltaE, 1e-2);
  EXPECT_NEAR(comparison.colours[0].stop, std::log2(8.0 / 0.18), 1e-5);
  EXPECT_NEAR(comparison.colours[2].stop, -10.0, 1e-9);
}

TEST(ComparisonTest, WhatIsNotFiniteIsEqualOnlyToItself) {
  const std::vector<float> a = {NAN, 1, 1, 1, kInfinity, 1, 1, 1, 0, 0, 0, 1};
  EXPECT_EQ(comparePixels(acescg(), a, a).max, 0.0);
  std::vector<float> b = a;
  b[0] = 1.0F;
  EXPECT_EQ(comparePixels(acescg(), a, b).colours[0].deltaE, kInfinity);
  b = a;
  b[4] = -kInfinity;
  const Comparison comparison = comparePixels(acescg(), a, b);
  EXPECT_EQ(comparison.max, kInfinity);
  EXPECT_EQ(comparison.worst, 1U);
}

TEST(ComparisonTest, NothingHasNoDifference) {
  const Comparison comparison = summarise({});
  EXPECT_EQ(comparison.mean, 0.0);
  EXPECT_EQ(comparison.max, 0.0);
}

}  // namespace
}  // namespace metamer::sip
