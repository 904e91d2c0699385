// SPDX-License-Identifier: Apache-2.0
// Mix, mask, premultiplication, abort, identity.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>

#include "frame.h"

namespace bare_host {
namespace {

constexpr OfxRectI kBounds = {0, 0, 50, 40};

class OfxBlending : public ::testing::Test {
 protected:
  Host m_host{builtLibrary()};
  std::unique_ptr<Instance> m_effect = m_host.create(0, {{"outputIlluminant", "A"}, {"scene", "Data set"}});
  Frame m_source{{.bounds = kBounds}};
  Frame m_full{{.bounds = kBounds}};
  Frame m_output{{.bounds = kBounds}};

  void SetUp() override {
    m_source.fill(testPixel);
    m_effect->connect("Source", m_source.image());
    m_effect->connect("Output", m_full.image());
    ASSERT_EQ(m_effect->render(kBounds), kOfxStatOK);
    m_effect->connect("Output", m_output.image());
  }

  void render(const char* premultiplication = kOfxImageUnPreMultiplied) {
    m_effect->connect("Source", m_source.image(premultiplication));
    ASSERT_EQ(m_effect->render(kBounds), kOfxStatOK);
    ASSERT_EQ(m_effect->effect().imagesOut, 0);
  }
};

TEST_F(OfxBlending, MixGoesFromSourceToResult) {
  for (const double mix : {0.0, 0.25, 1.0}) {
    m_effect->set("mix", mix);
    render();
    for (int x = 0; x < kBounds.x2; ++x) {
      const auto from = m_source.at(x, 7);
      const auto to = m_full.at(x, 7);
      for (std::size_t k = 0; k < 3; ++k) {
        const double wanted = (1 - mix) * from[k] + mix * to[k];
        EXPECT_NEAR(m_output.at(x, 7)[k], wanted, 1e-6 * std::max(1.0, std::abs(wanted)));
      }
      EXPECT_EQ(m_output.at(x, 7)[3], from[3]);
      if (mix == 0.0 || mix == 1.0) {
        EXPECT_EQ(m_output.bytes(x, 7), (mix == 0.0 ? m_source : m_full).bytes(x, 7));
      }
    }
  }
}

TEST_F(OfxBlending, MaskScalesAndIsNothingBeyondItsBounds) {
  // In bytes and upside down, smaller than the picture.
  Frame mask({.bounds = {10, 5, 30, 20},
              .depth = kOfxBitDepthByte,
              .components = kOfxImageComponentAlpha,
              .padding = 5,
              .topDown = true});
  mask.fill([](int x, int) { return Frame::Rgba{0, 0, 0, x < 15 ? 0.0F : x < 20 ? 1.0F : 0.4F}; });
  m_effect->connect("Mask", mask.image());
  render();
  EXPECT_EQ(m_output.bytes(5, 10), m_source.bytes(5, 10));
  EXPECT_EQ(m_output.bytes(12, 10), m_source.bytes(12, 10));
  EXPECT_EQ(m_output.bytes(17, 10), m_full.bytes(17, 10));
  EXPECT_EQ(m_output.bytes(17, 30), m_source.bytes(17, 30));
  for (std::size_t k = 0; k < 3; ++k) {
    const double wanted = 0.6 * m_source.at(25, 10)[k] + 0.4 * m_full.at(25, 10)[k];
    EXPECT_NEAR(m_output.at(25, 10)[k], wanted, 1e-6 * std::max(1.0, std::abs(wanted)));
  }
}

TEST_F(OfxBlending, AConnectedMaskWithoutAPictureIsNothing) {
  m_effect->clip("Mask").properties.set(kOfxImageClipPropConnected, 1);
  render();
  EXPECT_EQ(m_output.bytes(17, 10), m_source.bytes(17, 10));
}

TEST_F(OfxBlending, PremultipliedLinearPixelsTransformAsTheyAre) {
  // T(a c) = a T(c), whatever a: the transform is homogeneous.
  m_source.fill([](int x, int y) {
    Frame::Rgba pixel = testPixel(x, y);
    for (std::size_t k = 0; k < 3; ++k) {
      pixel[k] *= pixel[3];
    }
    return pixel;
  });
  render(kOfxImagePreMultiplied);
  for (int x = 0; x < kBounds.x2; ++x) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double wanted = m_full.at(x, 3)[k] * m_full.at(x, 3)[3];
      EXPECT_NEAR(m_output.at(x, 3)[k], wanted, 3e-6 * std::max(1.0, std::abs(wanted)));
    }
  }
}

TEST_F(OfxBlending, PremultipliedLogPixelsAreDividedFirst) {
  m_effect->set("space", "ACEScct");
  const auto straight = [](int x, int y) {
    Frame::Rgba pixel = testPixel(x, y);
    for (std::size_t k = 0; k < 3; ++k) {
      pixel[k] = std::fmod(std::abs(pixel[k]), 1.0F);
    }
    return pixel;
  };
  m_source.fill(straight);
  render();
  Frame expected = m_output;
  m_source.fill([&](int x, int y) {
    Frame::Rgba pixel = straight(x, y);
    for (std::size_t k = 0; k < 3; ++k) {
      pixel[k] = pixel[3] > 0 ? pixel[k] * pixel[3] : 0.25F;
    }
    return pixel;
  });
  render(kOfxImagePreMultiplied);
  for (int x = 0; x < kBounds.x2; ++x) {
    const float alpha = m_source.at(x, 9)[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const float wanted = alpha > 0 ? expected.at(x, 9)[k] * alpha : 0.25F;
      // The quotient's last bit is a step of light that a log curve makes thousands of times larger at its top end.
      EXPECT_NEAR(m_output.at(x, 9)[k], wanted, 1e-4 * std::max(1.0F, std::abs(wanted)));
    }
  }
}

TEST(OfxAbort, StopsEarlyAndReturnsCleanly) {
  // One thread: which rows are done between two questions is the same every time.
  const Host host(builtLibrary(), {.threads = 1});
  const std::unique_ptr<Instance> effect = host.create(0, {{"outputIlluminant", "A"}});
  const OfxRectI large = {0, 0, 2048, 512};
  Frame source({.bounds = large});
  source.fill([](int, int) { return Frame::Rgba{0.2F, 0.3F, 0.4F, 1}; });
  effect->connect("Source", source.image());
  const auto renderedUntil = [&](int polls) {
    Frame output({.bounds = large});
    effect->connect("Output", output.image());
    effect->effect().polls = 0;
    effect->effect().pollsToAbort = polls;
    EXPECT_EQ(effect->render(large), kOfxStatOK);
    EXPECT_EQ(effect->effect().imagesOut, 0);
    return std::pair(output.at(0, 0) != Frame::Rgba{}, output.at(2047, 511) != Frame::Rgba{});
  };
  EXPECT_EQ(renderedUntil(0), std::pair(false, false));
  EXPECT_EQ(renderedUntil(3), std::pair(true, false));
  EXPECT_EQ(renderedUntil(-1), std::pair(true, true));
  EXPECT_GT(effect->effect().polls, 4);
}

TEST_F(OfxBlending, IdentityIsToldAndOnlyThen) {
  EXPECT_EQ(m_effect->identity(kBounds), "");
  m_effect->set("mix", 0.0);
  EXPECT_EQ(m_effect->identity(kBounds), "Source");
  m_effect->set("mix", 1.0);
  m_effect->set("outputIlluminant", "D65");
  EXPECT_EQ(m_effect->identity(kBounds), "Source");
  m_effect->set("outputFilter", "Lee 209 0.3ND");
  EXPECT_EQ(m_effect->identity(kBounds), "");
  m_effect->set("outputDensity", 0.0);
  EXPECT_EQ(m_effect->identity(kBounds), "Source");
  m_effect->set("outputIlluminant", "A");
  m_source = Frame({.bounds = kBounds, .components = kOfxImageComponentAlpha});
  m_effect->connect("Source", m_source.image());
  EXPECT_EQ(m_effect->identity(kBounds), "Source");
}

TEST_F(OfxBlending, AnIdentityThatIsRenderedAllTheSameCopies) {
  m_effect->set("outputIlluminant", "D65");
  render();
  for (int x = 0; x < kBounds.x2; ++x) {
    EXPECT_EQ(m_output.bytes(x, 7), m_source.bytes(x, 7));
  }
}

TEST_F(OfxBlending, AnimatedParametersAreReadAtTheirTime) {
  m_effect->set("outputIlluminant", "Blackbody");
  m_effect->animate("outputTemperature", [](double time) { return 2000 + 1000 * time; });
  ASSERT_EQ(m_effect->render(kBounds, 0), kOfxStatOK);
  const auto warm = m_output.at(3, 3);
  ASSERT_EQ(m_effect->render(kBounds, 4), kOfxStatOK);
  const auto cool = m_output.at(3, 3);
  EXPECT_GT(warm[0] / warm[2], 1.1 * cool[0] / cool[2]);
  ASSERT_EQ(m_effect->render(kBounds, 0), kOfxStatOK);
  EXPECT_EQ(m_output.at(3, 3), warm);
}

}  // namespace
}  // namespace bare_host
