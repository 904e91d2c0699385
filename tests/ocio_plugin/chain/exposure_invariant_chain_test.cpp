// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/exposure_invariant_chain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include "metamer/ocio/pixel_processor.h"
#include "metamer/sip/error_protocol.h"
#include "sip/sip_fixture.h"

namespace metamer::ocio {
namespace {

constexpr int kBandCount = 161;

std::array<float, 3> applied(const PixelProcessor& processor, const std::array<float, 3>& rgb) {
  std::array<float, 4> pixel = {rgb[0], rgb[1], rgb[2], 0.25F};
  processor.apply(pixel);
  EXPECT_EQ(pixel[3], 0.25F);
  return {pixel[0], pixel[1], pixel[2]};
}

PixelProcessor chainOf(const sip::TransformSpec& spec, const ChainOptions& options = {}) {
  return PixelProcessor(exposureInvariantChain(spec, sip::SpectralTransform(spec, kBandCount), options));
}

class ChainPairTest : public testing::TestWithParam<std::size_t> {};

// The goal of the design, over exposures twice as wide as the protocol's.
TEST_P(ChainPairTest, HoldsTheProtocol) {
  const auto& [from, to] = sip::lightPairs()[GetParam()];
  const sip::TransformSpec spec = sip::specOf(from, to);
  const PixelProcessor processor = chainOf(spec);
  const sip::ErrorProtocol protocol(spec, sip::chart(), {.lowestStop = -20, .highestStop = 20});
  const auto report = protocol.measure([&](std::span<float> rgba) { processor.apply(rgba); });
  std::printf("%s -> %s: mean %.3f p99 %.3f max %.3f (%s)\n", from.c_str(), to.c_str(), report.mean, report.p99,
              report.max, report.worstProbe.c_str());
  EXPECT_LE(report.p99, 0.5);
  EXPECT_LE(report.max, 3.0);
}

INSTANTIATE_TEST_SUITE_P(All, ChainPairTest, testing::Range(std::size_t{0}, std::size_t{6}));

class ChainTest : public testing::Test {
 protected:
  ChainTest() : m_spec(sip::specOf("D65", "HP1")), m_transform(m_spec, kBandCount) {}
  sip::TransformSpec m_spec;
  sip::SpectralTransform m_transform;
  /// Built once: its build takes longer than any of the tests.
  static const PixelProcessor& builtChain() {
    static const PixelProcessor chain = chainOf(sip::specOf("D65", "HP1"));
    return chain;
  }
  const PixelProcessor& m_chain = builtChain();
};

// Where the table is looked up, a value's logarithm is a float between 0 and 1 that stands for 115 stops: a unit in its
// last place is 5e-6 of the light. It is rounded a handful of times, and the way back from wide channels takes twice
// that.
TEST_F(ChainTest, AGainGoesThroughAsAGain) {
  for (const std::array<float, 3>& colour : {std::array{0.18F, 0.18F, 0.18F}, std::array{0.3F, 0.05F, 0.02F},
                                             std::array{0.01F, 0.03F, 0.2F}, std::array{0.1F, 0.3F, -0.002F}}) {
    const auto middle = applied(m_chain, colour);
    for (int stop = -20; stop <= 20; ++stop) {
      const float gain = std::ldexp(1.0F, stop);
      const auto result = applied(m_chain, {gain * colour[0], gain * colour[1], gain * colour[2]});
      const float size = std::max({std::abs(middle[0]), std::abs(middle[1]), std::abs(middle[2])});
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(result[k] / gain, middle[k], 4e-5 * static_cast<double>(size)) << "stop " << stop;
      }
    }
  }
}

// Sensor noise and saturated lights: every direction of RGB, below zero as well.
TEST(ChainPixelTest, NoPixelIsFarOff) {
  const std::array<std::array<const char*, 2>, 4> pairs = {
      {{"LED-RGB1", "D65"}, {"FL11", "D65"}, {"A", "D65"}, {"D65", "HP1"}}};
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (const auto& [from, to] : pairs) {
    sip::TransformSpec spec = sip::naturalSpecOf(from, to);
    spec.adaptation = 1.0;
    const sip::SpectralTransform transform(spec, kBandCount);
    const PixelProcessor chain(exposureInvariantChain(spec, transform));
    std::vector<Eigen::Vector3d> pixels;
    // A camera's noise: photons', and a floor of 0.0015. A tenth of the chart's patches lie in deep shadow.
    const sip::ErrorProtocol chart(spec, sip::chart(), {.chromaticityCount = 0, .ringCount = 0});
    for (const auto& patch : chart.probes()) {
      for (int k = 0; k < 1000; ++k) {
        const Eigen::Vector3d light = (k % 10 == 0 ? 1e-3 : 1.0) * patch.rgb;
        const auto noise = [&](double value) {
          return value + std::sqrt(0.0015 * std::max(value, 0.0) + 0.0015 * 0.0015) * normal(random);
        };
        pixels.emplace_back(light.unaryExpr(noise));
      }
    }
    const std::size_t noisy = pixels.size();
    for (int k = 0; k < 4000; ++k) {
      pixels.emplace_back(normal(random), normal(random), normal(random));
    }
    std::vector<double> errors;
    for (const auto& pixel : pixels) {
      const Eigen::Vector3f in = pixel.cast<float>();
      const auto result = applied(chain, {in[0], in[1], in[2]});
      const Eigen::Vector3d exact = transform.apply(Eigen::Vector3d(in.cast<double>()));
      errors.push_back((Eigen::Vector3f(result[0], result[1], result[2]).cast<double>() - exact).cwiseAbs().maxCoeff() /
                       pixel.cwiseAbs().maxCoeff());
    }
    std::sort(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(noisy));
    const double p999 = errors[noisy - noisy / 1000];
    const double most = errors[noisy - 1];
    const double anywhere = *std::max_element(errors.begin() + static_cast<std::ptrdiff_t>(noisy), errors.end());
    std::printf("%s -> %s: noisy p99.9 %.3f most %.3f; anywhere %.3f\n", from, to, p999, most, anywhere);
    EXPECT_LE(p999, 0.15);
    EXPECT_LE(most, 0.5);
    EXPECT_LE(anywhere, 0.5);
  }
}

TEST_F(ChainTest, GreyRampIsMonotoneAndHasOneColour) {
  const auto middle = applied(m_chain, {1.0F, 1.0F, 1.0F});
  const Eigen::Vector3d exact = m_transform.apply(Eigen::Vector3d(1.0, 1.0, 1.0));
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(middle[k], exact[static_cast<Eigen::Index>(k)], 2e-5) << "white is held exactly";
  }
  std::array<float, 3> before = {-1.0F, -1.0F, -1.0F};
  for (int step = 0; step < 4096; ++step) {
    const float grey = 0.18F * std::exp2(-10.0F + 16.0F * static_cast<float>(step) / 4095.0F);
    const auto result = applied(m_chain, {grey, grey, grey});
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_GT(result[k] * (middle[k] > 0 ? 1.0F : -1.0F), before[k]) << "step " << step;
      before[k] = result[k] * (middle[k] > 0 ? 1.0F : -1.0F);
      EXPECT_NEAR(result[k] / grey, middle[k], 3e-5);
    }
  }
}

TEST_F(ChainTest, NeutralsStayNeutralWhereTheEyeAdapts) {
  sip::TransformSpec spec = m_spec;
  spec.adaptation = 1.0;
  const PixelProcessor chain = chainOf(spec, {.size = 33});
  for (const float grey : {1e-4F, 0.18F, 60.0F}) {
    const auto result = applied(chain, {grey, grey, grey});
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(result[k] / grey, 1.0, 1e-4);
    }
  }
}

// A scene that is curved even at white: there a least-squares fit alone would miss it.
TEST_F(ChainTest, WhiteIsHeldWhereTheEngineIsCurved) {
  sip::TransformSpec spec = m_spec;
  spec.scene = {.kind = sip::ReferenceScene::Kind::Natural, .samples = sip::samplesOf("colorchecker")};
  const sip::SpectralTransform transform(spec, kBandCount);
  const PixelProcessor chain(exposureInvariantChain(spec, transform, {.size = 9}));
  const auto result = applied(chain, {1.0F, 1.0F, 1.0F});
  const Eigen::Vector3d exact = transform.apply(Eigen::Vector3d(1.0, 1.0, 1.0));
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(result[k], exact[static_cast<Eigen::Index>(k)], 1e-5);
  }
}

TEST_F(ChainTest, BlackIsBlackAndFinitePixelsStayFinite) {
  for (const float value : applied(m_chain, {0.0F, 0.0F, 0.0F})) {
    EXPECT_LE(std::abs(value), 1e-6F);
  }
  const float largest = std::numeric_limits<float>::max();
  const float denormal = std::numeric_limits<float>::denorm_min();
  const std::array<float, 14> values = {0.0F,  -0.0F,  denormal, -denormal, 1e-30F, -1e-30F, 1e-6F,
                                        0.18F, -0.18F, 65504.0F, -65504.0F, 1e30F,  -1e30F,  largest};
  for (const float r : values) {
    for (const float g : values) {
      for (const float b : values) {
        for (const float value : applied(m_chain, {r, g, b})) {
          ASSERT_TRUE(std::isfinite(value)) << r << " " << g << " " << b;
        }
      }
    }
  }
}

// A pixel that is not a number must not reach the others, or crash the look-up.
TEST_F(ChainTest, NotANumberStaysInItsPixel) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  std::vector<float> pixels;
  for (int k = 0; k < 33; ++k) {
    pixels.insert(pixels.end(), {0.2F, 0.3F, 0.1F, 1.0F, nan, infinity, -infinity, 1.0F});
  }
  m_chain.apply(pixels);
  for (std::size_t k = 0; k < pixels.size(); k += 8) {
    EXPECT_EQ(pixels[k], pixels[0]);
    EXPECT_TRUE(std::isfinite(pixels[k]));
  }
}

// Lights that leave the engine a nearly or wholly singular problem: the chain must still be made, and be finite.
TEST(ChainHardCaseTest, NarrowLights) {
  for (const char* name : {"LED-RGB1", "HP1", "FL12"}) {
    for (const bool isInput : {true, false}) {
      const sip::TransformSpec spec = isInput ? sip::specOf(name, "D65") : sip::specOf("A", name);
      const PixelProcessor chain = chainOf(spec, {.size = 17});
      for (const float value : applied(chain, {0.2F, 0.2F, 0.2F})) {
        EXPECT_TRUE(std::isfinite(value));
      }
    }
  }
  // One line: no two channels can be told apart.
  sip::TransformSpec spec = sip::specOf("D65", "D65");
  spec.input.illuminant = spectral::Spectrum("line", spectral::SpectralQuantity::SpectralPowerDistribution,
                                             {588.0, 589.0, 590.0}, {0.0, 1.0, 0.0});
  const PixelProcessor chain = chainOf(spec, {.size = 17});
  for (const float value : applied(chain, {0.3F, 0.2F, 0.1F})) {
    EXPECT_TRUE(std::isfinite(value));
  }
}

}  // namespace
}  // namespace metamer::ocio
