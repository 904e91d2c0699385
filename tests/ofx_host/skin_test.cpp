// SPDX-License-Identifier: Apache-2.0
// The effect Skin in the bare host.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

#include "frame.h"

namespace bare_host {
namespace {

constexpr int kSkin = 2;
constexpr OfxRectI kBounds = {0, 0, 40, 20};
using Settings = std::map<std::string, Properties::Value>;

/// Skins of several depths in ACEScg, in light and shade.
Frame::Rgba skinPixel(int x, int y) {
  const float depth = static_cast<float>(x) / 40;
  const float mean = (0.45F - 0.37F * depth) * std::exp2(static_cast<float>(y - 10) / 2);
  return {mean * (1.25F + 0.08F * depth), mean * 0.985F, mean * (0.765F - 0.08F * depth),
          0.25F + 0.01F * static_cast<float>(y)};
}

class OfxSkin : public ::testing::Test {
 protected:
  Host m_host{builtLibrary(), {.threads = 2}};
  Frame m_source{{.bounds = kBounds}};
  Frame m_output{{.bounds = kBounds}};

  const Frame& render(Instance& effect, const char* premultiplication = kOfxImageUnPreMultiplied) {
    effect.connect("Source", m_source.image(premultiplication));
    effect.connect("Output", m_output.image(premultiplication));
    EXPECT_EQ(effect.render(kBounds), kOfxStatOK);
    EXPECT_EQ(effect.effect().imagesOut, 0);
    EXPECT_EQ(effect.message(), "");
    return m_output;
  }
};

/// The largest difference over all pixels, of the pixel's own size.
float largestDifference(const Frame& one, const Frame& other) {
  float largest = 0;
  for (int y = kBounds.y1; y < kBounds.y2; ++y) {
    for (int x = kBounds.x1; x < kBounds.x2; ++x) {
      const auto a = one.at(x, y);
      const auto b = other.at(x, y);
      const float size = std::max({std::abs(a[0]), std::abs(a[1]), std::abs(a[2]), 1e-9F});
      for (std::size_t k = 0; k < 3; ++k) {
        largest = std::max(largest, std::abs(a[k] - b[k]) / size);
      }
    }
  }
  return largest;
}

TEST_F(OfxSkin, NeutralParametersAreAnExactNoOp) {
  m_source.fill(testPixel);
  for (const Settings& settings : {Settings{}, Settings{{"strength", 0.0}, {"blood", 2.0}, {"melanin", 0.5}},
                                   Settings{{"matte", 0}, {"space", "ACEScct"}, {"quality", "Exact"}}}) {
    const auto effect = m_host.create(kSkin, settings);
    EXPECT_EQ(effect->identity(kBounds), "Source");
    render(*effect);
    for (int x = 0; x < kBounds.x2; ++x) {
      EXPECT_EQ(m_output.bytes(x, 7), m_source.bytes(x, 7));
    }
  }
}

TEST_F(OfxSkin, MapIsTheExactLookWithinAThousandthOnSkin) {
  for (const Settings& settings :
       {Settings{{"blood", 1.6}, {"melanin", 0.7}}, Settings{{"tan", 1.0}, {"flush", 0.5}, {"oxygenation", -0.5}}}) {
    for (const int matte : {0, 1}) {
      const auto effect = m_host.create(kSkin, settings);
      effect->set("matte", matte);
      for (const bool isSkin : {true, false}) {
        m_source.fill(isSkin ? skinPixel : testPixel);
        const Frame map = render(*effect);
        effect->set("quality", "Exact");
        const float difference = largestDifference(m_source, render(*effect));
        const float apart = largestDifference(map, m_output);
        std::printf("[ skin ] map against exact %.1e of a pixel; edit %.2f\n", static_cast<double>(apart),
                    static_cast<double>(difference));
        // Of a pixel on skin; of the change elsewhere, which without the matte is large.
        EXPECT_LE(apart, isSkin ? 1e-3F : 0.01F * difference);
        EXPECT_GT(difference, 0.04F);
        effect->set("quality", "Map");
      }
    }
  }
}

TEST_F(OfxSkin, ExposureAndPremultiplicationChangeNothing) {
  const auto effect = m_host.create(kSkin, {{"blood", 1.5}, {"melanin", 1.3}});
  m_source.fill(skinPixel);
  const Frame plain = render(*effect);
  m_source.fill([](int x, int y) {
    const auto pixel = skinPixel(x, y);
    return Frame::Rgba{1024 * pixel[0], 1024 * pixel[1], 1024 * pixel[2], pixel[3]};
  });
  render(*effect);
  for (int x = 0; x < kBounds.x2; ++x) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(m_output.at(x, 5)[k], 1024 * plain.at(x, 5)[k]);
    }
    EXPECT_EQ(m_output.at(x, 5)[3], plain.at(x, 5)[3]);
  }
  m_source.fill(skinPixel);
  render(*effect, kOfxImagePreMultiplied);
  EXPECT_EQ(m_output.bytes(9, 9), plain.bytes(9, 9));
}

TEST_F(OfxSkin, BloodReddensMelaninDarkensAndOthersStay) {
  m_source.fill(skinPixel);
  const auto effect = m_host.create(kSkin, {{"blood", 2.0}});
  render(*effect);
  const auto before = m_source.at(5, 10);
  const auto blood = m_output.at(5, 10);
  EXPECT_GT(blood[0] / blood[1], 1.02F * before[0] / before[1]);
  effect->set("blood", 1.0);
  effect->set("melanin", 2.0);
  render(*effect);
  const auto melanin = m_output.at(5, 10);
  EXPECT_LT(melanin[1], 0.9F * before[1]);
  // A blue, a green, a grey.
  m_source.fill([](int x, int) {
    return x % 3 == 0   ? Frame::Rgba{0.05F, 0.1F, 0.6F, 1}
           : x % 3 == 1 ? Frame::Rgba{0.1F, 0.7F, 0.1F, 1}
                        : Frame::Rgba{0.4F, 0.4F, 0.4F, 1};
  });
  EXPECT_LE(largestDifference(m_source, render(*effect)), 1e-3F);
  effect->set("matte", 0);
  EXPECT_GT(largestDifference(m_source, render(*effect)), 1e-2F);
}

TEST_F(OfxSkin, EncodedPixelsAreDecodedAround) {
  const auto linear = m_host.create(kSkin, {{"blood", 1.7}});
  const auto encoded = m_host.create(kSkin, {{"blood", 1.7}, {"space", "ACEScct"}});
  m_source.fill(skinPixel);
  const Frame wanted = render(*linear);
  const auto acescct = [](float light) { return static_cast<float>((std::log2(light) + 9.72) / 17.52); };
  m_source.fill([&](int x, int y) {
    const auto pixel = skinPixel(x, y);
    return Frame::Rgba{acescct(pixel[0]), acescct(pixel[1]), acescct(pixel[2]), 1};
  });
  render(*encoded);
  for (int x = 0; x < kBounds.x2; ++x) {
    for (std::size_t k = 0; k < 3; ++k) {
      // ACEScct's linear part begins below these lights.
      EXPECT_NEAR(m_output.at(x, 12)[k], acescct(wanted.at(x, 12)[k]), 2e-6F);
    }
  }
}

TEST_F(OfxSkin, NumbersThatAreNoneStayAndTheMaskScales) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const auto effect = m_host.create(kSkin, {{"blood", 2.0}, {"matte", 0}});
  m_source.fill([](int x, int y) {
    auto pixel = skinPixel(x, y);
    pixel[static_cast<std::size_t>(x % 3)] = x % 4 == 0   ? std::numeric_limits<float>::quiet_NaN()
                                             : x % 4 == 1 ? kInfinity
                                             : x % 4 == 2 ? -kInfinity
                                                          : -5.0F;
    return pixel;
  });
  render(*effect);
  for (int x = 0; x < kBounds.x2; ++x) {
    EXPECT_EQ(m_output.bytes(x, 3), m_source.bytes(x, 3)) << x;
  }
  m_source.fill(skinPixel);
  const Frame whole = render(*effect);
  Frame mask({.bounds = kBounds, .components = kOfxImageComponentAlpha});
  mask.fill([](int, int) { return Frame::Rgba{0.5F, 0.5F, 0.5F, 0.5F}; });
  effect->connect("Mask", mask.image());
  render(*effect);
  const auto half = m_output.at(4, 10);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(half[k], 0.5F * (whole.at(4, 10)[k] + skinPixel(4, 10)[k]), 1e-6F);
  }
}

TEST_F(OfxSkin, RandomParametersOnRandomWindows) {
  // METAMER_LONG=1: more.
  const int count = std::getenv("METAMER_LONG") != nullptr ? 5000 : 150;
  std::mt19937 random(77);
  const auto below = [&](int most) { return static_cast<int>(random() % static_cast<unsigned>(most)); };
  const auto effect = m_host.create(kSkin);
  const std::vector<std::string> depths = {kOfxBitDepthFloat, kOfxBitDepthHalf, kOfxBitDepthShort, kOfxBitDepthByte};
  const std::vector<std::string> components = {kOfxImageComponentRGBA, kOfxImageComponentRGB, kOfxImageComponentAlpha};
  const auto shape = [&] {
    const int x = below(41) - 20;
    const int y = below(41) - 20;
    return Frame::Shape{.bounds = {x, y, x + below(25), y + below(13)},
                        .depth = depths[static_cast<std::size_t>(below(4))],
                        .components = components[static_cast<std::size_t>(below(16) == 0 ? 2 : below(2))],
                        .padding = below(10),
                        .topDown = below(2) == 0};
  };
  // An estimator takes most of a second: two.
  effect->set("illuminant", "D65");
  int transformed = 0;
  for (int i = 0; i < count; ++i) {
    for (const auto& [name, most] : std::map<std::string, double>{
             {"melanin", 4}, {"blood", 4}, {"tan", 4}, {"flush", 4}, {"reach", 6}, {"strength", 1}, {"mix", 1}}) {
      const double unit = static_cast<double>(random()) / 4294967296.0;
      effect->set(name, below(60) == 0 ? -1.0 : most * unit);
    }
    effect->set("oxygenation", below(3) - 1.0);
    effect->set("matte", below(2));
    effect->set("space", below(2) == 0 ? "ACEScg" : "ACEScct");
    effect->set("quality", below(4) == 0 ? "Exact" : "Map");
    Frame source(shape());
    source.fill(below(2) == 0 ? testPixel : skinPixel);
    Frame output(shape());
    effect->connect("Source", source.image(below(2) == 0 ? kOfxImagePreMultiplied : kOfxImageUnPreMultiplied));
    effect->connect("Output", output.image());
    const OfxRectI window = shape().bounds;
    effect->identity(window, i);
    ASSERT_EQ(effect->render(window, i), kOfxStatOK) << i;
    ASSERT_TRUE(output.isGuardIntact()) << i;
    transformed += effect->message().empty() ? 1 : 0;
    const OfxRectI& bounds = output.shape().bounds;
    for (int y = bounds.y1; y < bounds.y2; ++y) {
      for (int x = bounds.x1; x < bounds.x2; ++x) {
        for (const float value : output.at(x, y)) {
          ASSERT_FALSE(std::isnan(value)) << i << " at " << x << " " << y;
        }
      }
    }
  }
  EXPECT_GT(transformed, count / 2);
}

}  // namespace
}  // namespace bare_host
