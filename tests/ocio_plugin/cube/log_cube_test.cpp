// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/log_cube.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <random>
#include <tuple>
#include <vector>

#include "cube/shaper_curve.h"
#include "metamer/ocio/pixel_processor.h"
#include "metamer/ocio/shaper.h"
#include "metamer/sip/error_protocol.h"
#include "metamer/spectral/colorimetry.h"
#include "sip/sip_fixture.h"

namespace metamer::ocio {
namespace {

constexpr int kBandCount = 161;
constexpr auto kEncoding = spectral::LogEncoding::AcesCct;

Signal signal() {
  return {shaperTransform(kEncoding, OCIO::TRANSFORM_DIR_INVERSE),
          shaperTransform(kEncoding, OCIO::TRANSFORM_DIR_FORWARD)};
}

/// A cube as what it does to light: to the signal, the 1-D shaper where there is one, the table, back to light.
PixelProcessor throughLight(const OCIO::Lut3DTransformRcPtr& table,
                            const OCIO::ConstTransformRcPtr& shaperCurve = nullptr) {
  auto group = OCIO::GroupTransform::Create();
  group->appendTransform(shaperTransform(kEncoding, OCIO::TRANSFORM_DIR_FORWARD));
  if (shaperCurve) {
    group->appendTransform(shaperCurve->createEditableCopy());
  }
  group->appendTransform(table);
  group->appendTransform(shaperTransform(kEncoding, OCIO::TRANSFORM_DIR_INVERSE));
  return PixelProcessor(group);
}

std::array<float, 3> nodeOf(const OCIO::Lut3DTransformRcPtr& table, int red, int green, int blue) {
  std::array<float, 3> value{};
  table->getValue(static_cast<unsigned long>(red), static_cast<unsigned long>(green), static_cast<unsigned long>(blue),
                  value[0], value[1], value[2]);
  return value;
}

struct Target {
  const char* to;
  double part;      ///< of the sampled cube's 99th percentile at the same size
  double ofTwice;   ///< of a sampled cube's with 65 nodes
  double shapedOf;  ///< of the same, for a table behind a 1-D shaper
};

class FittedCubeTest : public testing::TestWithParam<Target> {};

// The bounded engine bends less, which helps sampled cubes most: under A 65 sampled nodes fell from 1.81 to 1.42, 33
// fitted ones from 1.98 to 1.75 (behind a 1-D shaper from 0.69 to 0.68; HP1 1.04 to 0.58, FL11 1.04 to 0.72). So the
// fit's lead over twice the nodes is smaller than it was, and its errors are too.

// The design's goal is a third of the sampled cube's error and no more than that of 65 nodes. Under A the second is
// missed by a tenth where there is no 1-D shaper: in the toe of ACEScct, where it lies, 65 nodes have eight times the
// freedom (docs/representations.md).
TEST_P(FittedCubeTest, IsWorthTwiceTheNodes) {
  const sip::TransformSpec spec = sip::specOf("D65", GetParam().to);
  const sip::SpectralTransform transform(spec, kBandCount);
  const sip::ErrorProtocol protocol(spec, sip::chart(), {.lowestStop = -7, .highestStop = 7, .insideGamutOnly = true});
  const auto p99 = [&](const LogCubeOptions& options) {
    const std::clock_t start = std::clock();
    const auto table = logCube(transform, signal(), options);
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    const PixelProcessor processor = throughLight(table, options.shaperCurve);
    const auto report = protocol.measure([&](std::span<float> rgba) { processor.apply(rgba); });
    std::printf("D65 -> %s, %s %d%s: mean %.3f p99 %.3f max %.3f, %.2f s of one core\n", GetParam().to,
                options.fitted ? "fitted" : "sampled", options.size, options.shaperCurve ? " behind a 1-D shaper" : "",
                report.mean, report.p99, report.max, seconds);
    return report.p99;
  };
  const double fitted = p99({.size = 33});
  EXPECT_LE(fitted, GetParam().part * p99({.size = 33, .fitted = false}));
  const double ofTwice = p99({.size = 65, .fitted = false});
  EXPECT_LE(fitted, GetParam().ofTwice * ofTwice);
  EXPECT_LE(p99({.size = 33, .shaperCurve = shaperCurve(signal(), 33, -7.0, kShaperCurveEntries)}),
            GetParam().shapedOf * ofTwice);
}

INSTANTIATE_TEST_SUITE_P(Lights, FittedCubeTest,
                         testing::Values(Target{"A", 1.0 / 3.0, 1.25, 0.5}, Target{"HP1", 1.0 / 3.0, 1.0, 0.15},
                                         Target{"FL11", 1.0 / 3.0, 1.0, 0.33}),
                         [](const auto& instance) { return instance.param.to; });

class LogCubeTest : public testing::Test {
 protected:
  LogCubeTest() : m_spec(sip::specOf("D65", "HP1")), m_transform(m_spec, kBandCount) {}
  sip::TransformSpec m_spec;
  sip::SpectralTransform m_transform;
};

TEST_F(LogCubeTest, NeutralNodesAreExact) {
  const auto fitted = logCube(m_transform, signal(), {.size = 17});
  const auto sampled = logCube(m_transform, signal(), {.size = 17, .fitted = false});
  bool moved = false;
  for (int k = 0; k < 17; ++k) {
    const double light = spectral::decode(kEncoding, k / 16.0);
    if (light < 0.0 && spectral::decode(kEncoding, (k + 1) / 16.0) > 0.0) {
      continue;  // keeps black black
    }
    const Eigen::Vector3d exact = m_transform.apply(Eigen::Vector3d::Constant(light));
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const double wanted = spectral::encode(kEncoding, exact[static_cast<Eigen::Index>(channel)]);
      EXPECT_NEAR(nodeOf(fitted, k, k, k)[channel], wanted, 2e-6) << k;
    }
    moved = moved || nodeOf(fitted, k, k / 2, 0) != nodeOf(sampled, k, k / 2, 0);
  }
  EXPECT_TRUE(moved);
}

// Toward daylight with the eye left behind, a sodium lamp's blues grow eightfold: between the nodes round black one
// result lies in the toe of the logarithm, the other far above.
TEST(LogCubeBlackTest, BlackStaysBlack) {
  const sip::SpectralTransform transform(sip::specOf("HP1", "D65"), kBandCount);
  for (const int size : {17, 33, 65}) {
    std::vector<OCIO::Lut1DTransformRcPtr> curves(1);
    if (size == 33) {
      curves.push_back(shaperCurve(signal(), size, -7.0, kShaperCurveEntries));
      curves.push_back(shaperCurve(signal(), size, -7.0, 50));
    }
    for (const auto& curve : curves) {
      const PixelProcessor processor =
          throughLight(logCube(transform, signal(), {.size = size, .shaperCurve = curve}), curve);
      std::array<float, 4> pixel = {0.0F, 0.0F, 0.0F, 1.0F};
      processor.apply(pixel);
      for (std::size_t channel = 0; channel < 3; ++channel) {
        EXPECT_NEAR(pixel[channel], 0.0F, 1e-7F) << size;
      }
    }
  }
}

// A sensor's noise in black lies below zero half of the time. A fit that knows only what lights make of surfaces tints
// it: by 0.0008 and 0.0012 here.
TEST(LogCubeBlackTest, NoiseKeepsItsColour) {
  constexpr std::ptrdiff_t kCount = 2000;
  for (const auto& [from, to, most] : {std::tuple("D65", "A", 0.0007), std::tuple("LED-RGB1", "D65", 0.00105)}) {
    sip::TransformSpec spec = sip::specOf(from, to);
    spec.adaptation = 1.0;
    const sip::SpectralTransform transform(spec, kBandCount);
    std::mt19937_64 random(1);
    std::normal_distribution<double> noise(0.0, 0.0012);
    std::vector<Eigen::Vector3d> exact(kCount);
    std::vector<float> out;
    for (Eigen::Vector3d& colour : exact) {
      colour = Eigen::Vector3d::NullaryExpr([&] { return noise(random); });
      for (const double channel : {colour[0], colour[1], colour[2], 1.0}) {
        out.push_back(static_cast<float>(channel));
      }
    }
    transform.apply(exact);
    throughLight(logCube(transform, signal(), {.size = 65})).apply(out);
    std::vector<double> distances(kCount);
    for (std::size_t k = 0; k < distances.size(); ++k) {
      const Eigen::Vector3d result = Eigen::Map<const Eigen::Vector3f>(out.data() + 4 * k).cast<double>();
      distances[k] = (result - exact[k]).cwiseAbs().maxCoeff();
    }
    const auto p99 = distances.begin() + kCount * 99 / 100;
    std::nth_element(distances.begin(), p99, distances.end());
    EXPECT_LT(*p99, most) << from << " to " << to;
  }
}

// Above the toe a diagonal of nodes is one chromaticity, solved once: what comes out must be the same as solving each.
TEST_F(LogCubeTest, SampledNodesAreTheTransformsValues) {
  const auto sampled = logCube(m_transform, signal(), {.size = 9, .fitted = false});
  for (int red = 0; red < 9; ++red) {
    for (int green = 0; green < 9; ++green) {
      for (int blue = 0; blue < 9; ++blue) {
        const Eigen::Vector3d light(spectral::decode(kEncoding, red / 8.0), spectral::decode(kEncoding, green / 8.0),
                                    spectral::decode(kEncoding, blue / 8.0));
        const Eigen::Vector3d exact = m_transform.apply(light);
        const auto node = nodeOf(sampled, red, green, blue);
        for (std::size_t channel = 0; channel < 3; ++channel) {
          const double wanted = spectral::encode(kEncoding, exact[static_cast<Eigen::Index>(channel)]);
          EXPECT_NEAR(node[channel], wanted, 3e-6 * std::max(1.0, std::abs(wanted))) << red << green << blue;
        }
      }
    }
  }
}

// The transform's own values far outside the gamut are as low as -113 here (a signal below the logarithm's toe). A
// fitted table keeps to what real colours become, and to 0 and above where a format holds whole numbers.
TEST_F(LogCubeTest, FittedNodesAreASignal) {
  const auto fitted = logCube(m_transform, signal(), {.size = 33});
  const auto clipped = logCube(m_transform, signal(), {.size = 33, .belowZero = false});
  const auto sampled = logCube(m_transform, signal(), {.size = 33, .fitted = false});
  std::array<float, 3> lowest{};
  std::array<float, 3> lowestOwn{};
  for (int red = 0; red < 33; ++red) {
    for (int green = 0; green < 33; ++green) {
      for (int blue = 0; blue < 33; ++blue) {
        const auto node = nodeOf(fitted, red, green, blue);
        const auto bounded = nodeOf(clipped, red, green, blue);
        const auto own = nodeOf(sampled, red, green, blue);
        for (std::size_t channel = 0; channel < 3; ++channel) {
          lowest[channel] = std::min(lowest[channel], node[channel]);
          lowestOwn[channel] = std::min(lowestOwn[channel], own[channel]);
          ASSERT_GE(bounded[channel], 0.0F) << red << " " << green << " " << blue;
          ASSERT_LE(node[channel], std::max(1.0F, own[channel])) << red << " " << green << " " << blue;
        }
      }
    }
  }
  EXPECT_LT(lowest[0], -0.1F);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    EXPECT_GE(lowest[channel], 0.6F * lowestOwn[channel]);
  }
}

// From tungsten to daylight, the eye adapted, saturated blues leave the gamut: where the table holds signals below 0
// they come out, where it does not they are clipped.
TEST(LogCubeGamutTest, WhatLeavesTheGamutIsKept) {
  sip::TransformSpec spec = sip::specOf("A", "D65");
  spec.adaptation = 1.0;
  const sip::SpectralTransform transform(spec, kBandCount);
  const sip::ErrorProtocol protocol(spec, sip::chart(), {.lowestStop = 0, .highestStop = 5, .insideGamutOnly = true});
  const auto p99 = [&](bool belowZero) {
    const PixelProcessor processor = throughLight(
        logCube(transform, signal(), {.size = 33, .lowestStop = 0, .highestStop = 5, .belowZero = belowZero}));
    const auto report = protocol.measure([&](std::span<float> rgba) { processor.apply(rgba); });
    std::printf("A -> D65 adapted, signals below 0 %s: p99 %.3f max %.3f\n", belowZero ? "kept" : "clipped", report.p99,
                report.max);
    return report.p99;
  };
  EXPECT_LE(p99(true), 0.5 * p99(false));
}

// Sodium to daylight, seen by an eye that stays behind: next to bright greys green leaves the gamut, so that signals
// fall from the logarithm far into its toe. What a square takes for large errors there must not bend the greys'
// neighbours.
TEST(LogCubeBrightTest, ColoursNearGreyAreAsGoodAsSampled) {
  const sip::SpectralTransform transform(sip::specOf("HP1", "D65"), kBandCount);
  const auto labOf = [&](const Eigen::Vector3d& rgb) {
    return spectral::lab(transform.space().xyzFromRgb() * rgb, transform.whiteXyz());
  };
  struct Colour {
    Eigen::Vector3d rgb;
    Eigen::Vector3d wanted;  ///< lab
  };
  std::vector<Colour> colours;
  for (const double red : {-0.5, -0.25, 0.0, 0.25, 0.5}) {
    for (const double green : {-0.5, -0.25, 0.0, 0.25, 0.5}) {
      for (const double blue : {-0.5, -0.25, 0.0, 0.25, 0.5}) {
        const Eigen::Vector3d rgb(0.18 * std::exp2(red), 0.18 * std::exp2(green), 0.18 * std::exp2(blue));
        colours.push_back({rgb, labOf(transform.apply(rgb))});
      }
    }
  }
  const auto worst = [&](bool fitted) {
    const PixelProcessor processor = throughLight(logCube(transform, signal(), {.size = 33, .fitted = fitted}));
    double largest = 0.0;
    for (const double exposure : {16.0, 32.0, 64.0, 128.0}) {
      for (const Colour& colour : colours) {
        const Eigen::Vector3f in = (exposure * colour.rgb).cast<float>();
        std::array<float, 4> pixel = {in[0], in[1], in[2], 1.0F};
        processor.apply(pixel);
        const Eigen::Vector3d out = Eigen::Map<const Eigen::Vector3f>(pixel.data()).cast<double>() / exposure;
        largest = std::max(largest, spectral::deltaE2000(colour.wanted, labOf(out)));
      }
    }
    std::printf("HP1 -> D65, near bright greys, %s: max %.2f\n", fitted ? "fitted" : "sampled", largest);
    return largest;
  };
  EXPECT_LE(worst(true), 1.1 * worst(false));
}

TEST_F(LogCubeTest, IsTheSameEveryTime) {
  const auto one = logCube(m_transform, signal(), {.size = 9});
  const auto two = logCube(m_transform, signal(), {.size = 9});
  EXPECT_TRUE(one->equals(*two));
}

// From the outermost nodes that real colours touch on, a ray away from neutral must not ring: its saturation may
// settle, not swing.
TEST_F(LogCubeTest, WhatNoColourTouchesFollowsItsNeighbours) {
  const auto fitted = logCube(m_transform, signal(), {.size = 33});
  const auto sampled = logCube(m_transform, signal(), {.size = 33, .fitted = false});
  // Fitted tables end at the lowest that real colours become.
  std::array<double, 3> lowest{};
  for (int red = 0; red < 33; ++red) {
    for (int green = 0; green < 33; ++green) {
      for (int blue = 0; blue < 33; ++blue) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
          lowest[channel] = std::min(lowest[channel], static_cast<double>(nodeOf(fitted, red, green, blue)[channel]));
        }
      }
    }
  }
  // Blue falls from a bright yellow-green to nothing: an edge of the lattice that runs out of the gamut.
  for (const auto& [red, green] : {std::pair{18, 20}, std::pair{20, 18}, std::pair{14, 24}}) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      double variation = 0.0;
      double own = 0.0;
      for (int blue = 0; blue < 32; ++blue) {
        variation += std::abs(static_cast<double>(nodeOf(fitted, red, green, blue + 1)[channel]) -
                              static_cast<double>(nodeOf(fitted, red, green, blue)[channel]));
        own += std::abs(std::max(lowest[channel], static_cast<double>(nodeOf(sampled, red, green, blue + 1)[channel])) -
                        std::max(lowest[channel], static_cast<double>(nodeOf(sampled, red, green, blue)[channel])));
      }
      std::printf("variation %.3f, of the transform itself %.3f\n", variation, own);
      EXPECT_LE(variation, own + 0.1);
    }
  }
}

}  // namespace
}  // namespace metamer::ocio
