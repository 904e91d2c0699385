// SPDX-License-Identifier: Apache-2.0
// Pictures in every shape of memory that a host may hand over.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "frame.h"

namespace bare_host {
namespace {

constexpr OfxRectI kBounds = {-7, 11, 58, 40};

class OfxImages : public ::testing::Test {
 protected:
  Host m_host{builtLibrary()};
  std::unique_ptr<Instance> m_effect =
      m_host.create(0, {{"outputIlluminant", "HP1"}, {"adaptation", 0.3}, {"scene", "Data set"}});

  /// The effect's result for a pixel on its own: a plain picture of one row.
  Frame::Rgba expected(const Frame::Rgba& pixel) {
    Frame source({.bounds = {0, 0, 1, 1}});
    Frame output({.bounds = {0, 0, 1, 1}});
    source.fill([&](int, int) { return pixel; });
    const Clip& before = m_effect->clip("Source");
    const Image keptSource = before.image;
    const Image keptOutput = m_effect->clip("Output").image;
    m_effect->connect("Source", source.image());
    m_effect->connect("Output", output.image());
    EXPECT_EQ(m_effect->render({0, 0, 1, 1}), kOfxStatOK);
    m_effect->connect("Source", keptSource);
    m_effect->connect("Output", keptOutput);
    return output.at(0, 0);
  }

  OfxStatus run(const Frame& source, const Frame& output, const OfxRectI& window,
                const std::string& field = kOfxImageFieldNone) {
    m_effect->connect("Source", source.image());
    m_effect->connect("Output", output.image());
    const OfxStatus status = m_effect->render(window, 0, field);
    EXPECT_EQ(m_effect->effect().imagesOut, 0);
    EXPECT_TRUE(output.isGuardIntact());
    return status;
  }
};

TEST_F(OfxImages, EveryStrideSignPaddingAndOriginGivesTheSamePixels) {
  Frame reference({.bounds = kBounds});
  Frame source({.bounds = kBounds});
  source.fill(testPixel);
  ASSERT_EQ(run(source, reference, kBounds), kOfxStatOK);
  EXPECT_EQ(reference.at(3, 20), expected(testPixel(3, 20)));
  for (const bool sourceTopDown : {false, true}) {
    for (const bool outputTopDown : {false, true}) {
      for (const int padding : {0, 4, 20, 7}) {
        Frame in(
            {.bounds = {-20, 0, 70, 55}, .padding = padding, .topDown = sourceTopDown, .misalignment = padding % 4});
        in.fill(testPixel);
        Frame out({.bounds = kBounds, .padding = padding, .topDown = outputTopDown, .misalignment = padding % 4});
        ASSERT_EQ(run(in, out, kBounds), kOfxStatOK);
        for (int y = kBounds.y1; y < kBounds.y2; ++y) {
          for (int x = kBounds.x1; x < kBounds.x2; ++x) {
            ASSERT_EQ(out.bytes(x, y), reference.bytes(x, y)) << x << " " << y << " padding " << padding;
          }
        }
      }
    }
  }
}

TEST_F(OfxImages, OnlyTheWindowIsWritten) {
  Frame source({.bounds = kBounds});
  source.fill(testPixel);
  Frame output({.bounds = kBounds});
  const Frame::Rgba marker = {0.5F, 0.25F, 0.125F, 0.75F};
  output.fill([&](int, int) { return marker; });
  const OfxRectI window = {0, 15, 9, 22};
  ASSERT_EQ(run(source, output, window), kOfxStatOK);
  for (int y = kBounds.y1; y < kBounds.y2; ++y) {
    for (int x = kBounds.x1; x < kBounds.x2; ++x) {
      const bool isInside = x >= window.x1 && x < window.x2 && y >= window.y1 && y < window.y2;
      EXPECT_EQ(output.at(x, y) == marker, !isInside);
    }
  }
}

TEST_F(OfxImages, BeyondTheSourceIsTransparentBlack) {
  Frame source({.bounds = {0, 12, 10, 20}});
  source.fill(testPixel);
  Frame output({.bounds = kBounds});
  output.fill([](int, int) { return Frame::Rgba{9, 9, 9, 9}; });
  ASSERT_EQ(run(source, output, kBounds), kOfxStatOK);
  EXPECT_EQ(output.at(-1, 15), (Frame::Rgba{0, 0, 0, 0}));
  EXPECT_EQ(output.at(5, 25), (Frame::Rgba{0, 0, 0, 0}));
  EXPECT_EQ(output.at(5, 15), expected(testPixel(5, 15)));
}

TEST_F(OfxImages, WindowsBeyondTheOutputEmptyOnesAndEmptyPictures) {
  Frame source({.bounds = kBounds});
  source.fill(testPixel);
  Frame output({.bounds = kBounds});
  EXPECT_EQ(run(source, output, {-1000000, -1000000, 1000000, 1000000}), kOfxStatOK);
  EXPECT_EQ(output.at(-7, 11), expected(testPixel(-7, 11)));
  EXPECT_EQ(run(source, output, {500, 500, 600, 600}), kOfxStatOK);
  EXPECT_EQ(run(source, output, {5, 15, 5, 20}), kOfxStatOK);
  EXPECT_EQ(run(source, output, {8, 20, 3, 15}), kOfxStatOK);
  Frame empty({.bounds = {3, 3, 3, 3}});
  EXPECT_EQ(run(empty, output, kBounds), kOfxStatOK);
  EXPECT_EQ(output.at(0, 20), (Frame::Rgba{0, 0, 0, 0}));
  EXPECT_EQ(run(source, empty, kBounds), kOfxStatOK);
}

TEST_F(OfxImages, OnePixelAndVeryWideOnes) {
  for (const int width : {1, 511, 512, 513, 8640, 40000}) {
    const OfxRectI bounds = {-3, 0, width - 3, 2};
    Frame source({.bounds = bounds});
    source.fill(testPixel);
    Frame output({.bounds = bounds});
    ASSERT_EQ(run(source, output, bounds), kOfxStatOK);
    for (const int x : {-3, (width - 1) / 2 - 3, width - 4}) {
      EXPECT_EQ(output.at(x, 1), expected(testPixel(x, 1))) << width;
    }
  }
}

TEST_F(OfxImages, WithoutASourceTheResultIsTransparentBlack) {
  Frame output({.bounds = kBounds});
  output.fill([](int, int) { return Frame::Rgba{9, 9, 9, 9}; });
  m_effect->connect("Output", output.image());
  EXPECT_EQ(m_effect->render(kBounds), kOfxStatOK);
  EXPECT_EQ(output.at(0, 20), (Frame::Rgba{0, 0, 0, 0}));
  EXPECT_EQ(m_effect->effect().imagesOut, 0);
}

TEST_F(OfxImages, WithoutAnOutputOrWithABrokenImageItFailsAndGivesEverythingBack) {
  Frame source({.bounds = kBounds});
  m_effect->connect("Source", source.image());
  EXPECT_EQ(m_effect->render(kBounds), kOfxStatFailed);
  Image broken = source.image();
  broken.depth = "OfxBitDepthOfTheFuture";
  m_effect->connect("Output", broken);
  EXPECT_EQ(m_effect->render(kBounds), kOfxStatErrImageFormat);
  broken = source.image();
  broken.data = nullptr;
  m_effect->connect("Output", broken);
  EXPECT_EQ(m_effect->render(kBounds), kOfxStatErrImageFormat);
  broken = source.image();
  broken.rowBytes = 8;
  m_effect->connect("Output", broken);
  EXPECT_EQ(m_effect->render(kBounds), kOfxStatErrImageFormat);
  EXPECT_EQ(m_effect->effect().imagesOut, 0);
}

TEST_F(OfxImages, FieldsWriteTheirOwnRows) {
  Frame source({.bounds = kBounds});
  source.fill(testPixel);
  for (const char* field : {kOfxImageFieldLower, kOfxImageFieldUpper, kOfxImageFieldBoth}) {
    Frame output({.bounds = kBounds});
    ASSERT_EQ(run(source, output, kBounds, field), kOfxStatOK);
    for (int y = kBounds.y1; y < kBounds.y2; ++y) {
      const bool isUpper = y % 2 != 0;
      const bool isRendered =
          field == std::string(kOfxImageFieldBoth) || isUpper == (field == std::string(kOfxImageFieldUpper));
      EXPECT_EQ(output.at(4, y) != (Frame::Rgba{}), isRendered) << field << " row " << y;
    }
  }
}

TEST_F(OfxImages, ProxiesAreTransformedPixelByPixel) {
  Frame wholeMask({.bounds = kBounds, .components = kOfxImageComponentAlpha});
  wholeMask.fill([](int x, int y) { return Frame::Rgba{0, 0, 0, (x + y) % 3 == 0 ? 1.0F : 0.25F}; });
  m_effect->connect("Mask", wholeMask.image());
  Frame wholeSource({.bounds = kBounds});
  wholeSource.fill(testPixel);
  Frame whole({.bounds = kBounds});
  ASSERT_EQ(run(wholeSource, whole, kBounds), kOfxStatOK);
  // Every second and third pixel, as a host that skips pixels for a proxy; bounds in pixels of the proxy.
  for (const auto& [stepX, stepY] : {std::pair(2, 2), std::pair(2, 1), std::pair(1, 3)}) {
    const OfxPointD scale{1.0 / stepX, 1.0 / stepY};
    const OfxRectI bounds = {-7 / stepX, 11 / stepY + 1, 57 / stepX, 39 / stepY};
    const auto skipped = [&, stepX = stepX, stepY = stepY](const Frame& frame) {
      return [&frame, stepX, stepY](int x, int y) { return frame.at(x * stepX, y * stepY); };
    };
    Frame source({.bounds = bounds, .padding = 12, .topDown = true});
    source.fill(skipped(wholeSource));
    Frame mask({.bounds = bounds, .components = kOfxImageComponentAlpha});
    mask.fill(skipped(wholeMask));
    Frame output({.bounds = bounds});
    const auto atScale = [&](const Frame& frame) {
      Image image = frame.image();
      image.renderScale = scale;
      return image;
    };
    m_effect->connect("Source", atScale(source));
    m_effect->connect("Mask", atScale(mask));
    m_effect->connect("Output", atScale(output));
    // In two tiles.
    const int middle = (bounds.x1 + bounds.x2) / 2;
    for (const OfxRectI& tile :
         {OfxRectI{bounds.x1, bounds.y1, middle, bounds.y2}, OfxRectI{middle, bounds.y1, bounds.x2, bounds.y2}}) {
      ASSERT_EQ(m_effect->render(tile, 0, kOfxImageFieldNone, scale), kOfxStatOK);
    }
    EXPECT_TRUE(output.isGuardIntact());
    for (int y = bounds.y1; y < bounds.y2; ++y) {
      for (int x = bounds.x1; x < bounds.x2; ++x) {
        ASSERT_EQ(output.bytes(x, y), whole.bytes(x * stepX, y * stepY)) << x << " " << y << " at 1/" << stepX;
      }
    }
  }
}

TEST_F(OfxImages, OverlappingMemoryIsReadBeforeItIsWritten) {
  Frame source({.bounds = kBounds});
  source.fill(testPixel);
  Frame reference({.bounds = kBounds});
  ASSERT_EQ(run(source, reference, kBounds), kOfxStatOK);
  // In place.
  ASSERT_EQ(run(source, source, kBounds), kOfxStatOK);
  EXPECT_EQ(source.bytes(5, 30), reference.bytes(5, 30));
  // One row up in the same memory: what is written as row y is read as row y + 1.
  source.fill(testPixel);
  Image shifted = source.image();
  shifted.bounds = {kBounds.x1, kBounds.y1 + 1, kBounds.x2, kBounds.y2 + 1};
  m_effect->connect("Source", shifted);
  m_effect->connect("Output", source.image());
  ASSERT_EQ(m_effect->render({kBounds.x1, kBounds.y1 + 1, kBounds.x2, kBounds.y2}), kOfxStatOK);
  for (int y = kBounds.y1 + 1; y < kBounds.y2; ++y) {
    EXPECT_EQ(source.at(5, y), expected(testPixel(5, y - 1))) << y;
  }
}

TEST_F(OfxImages, EveryDepthAndEveryComponents) {
  const auto rgb = [](int x, int y) {
    Frame::Rgba pixel = testPixel(x, y);
    for (float& value : pixel) {
      value = std::min(std::max(value, 0.0F), 1.0F);
    }
    return pixel;
  };
  // Half a code, and what the value itself may round in float.
  const std::map<std::string, float> tolerance = {
      {kOfxBitDepthByte, 0.51F / 255}, {kOfxBitDepthShort, 0.51F / 65535}, {kOfxBitDepthHalf, 1.0F / 2048}};
  for (const auto& [depth, step] : tolerance) {
    for (const char* components : {kOfxImageComponentRGBA, kOfxImageComponentRGB, kOfxImageComponentAlpha}) {
      Frame source({.bounds = kBounds, .depth = depth, .components = components, .padding = 3, .topDown = true});
      source.fill(rgb);
      Frame output({.bounds = kBounds, .depth = depth, .components = components, .padding = 1});
      ASSERT_EQ(run(source, output, kBounds), kOfxStatOK);
      for (int y = kBounds.y1; y < kBounds.y2; y += 3) {
        for (int x = kBounds.x1; x < kBounds.x2; ++x) {
          const Frame::Rgba given = source.at(x, y);
          if (components == std::string(kOfxImageComponentAlpha)) {
            EXPECT_EQ(output.bytes(x, y), source.bytes(x, y));
            continue;
          }
          const Frame::Rgba wanted = expected(given);
          for (std::size_t k = 0; k < 3; ++k) {
            const bool isHalf = depth == kOfxBitDepthHalf;
            const float clamped = isHalf ? wanted[k] : std::min(std::max(wanted[k], 0.0F), 1.0F);
            EXPECT_NEAR(output.at(x, y)[k], clamped, isHalf ? step * std::max(0.001F, std::abs(clamped)) : step);
          }
          EXPECT_EQ(output.at(x, y)[3], given[3]);
        }
      }
    }
  }
}

TEST_F(OfxImages, DepthsMayDifferBetweenClips) {
  Frame source({.bounds = kBounds, .depth = kOfxBitDepthHalf, .components = kOfxImageComponentRGB});
  source.fill(testPixel);
  Frame output({.bounds = kBounds});
  ASSERT_EQ(run(source, output, kBounds), kOfxStatOK);
  EXPECT_EQ(output.at(2, 20), expected(source.at(2, 20)));
}

TEST_F(OfxImages, WhatIsNoNumberStaysAndDoesNotSpread) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const char* space : {"ACEScg", "ACEScct"}) {
    m_effect->set("space", space);
    Frame source({.bounds = kBounds});
    source.fill([&](int x, int y) {
      Frame::Rgba pixel = testPixel(x, y);
      if ((x + y) % 5 == 0) {
        pixel[static_cast<std::size_t>(y % 3)] = x % 2 == 0 ? kNan : -kInfinity;
      }
      return pixel;
    });
    Frame output({.bounds = kBounds});
    ASSERT_EQ(run(source, output, kBounds), kOfxStatOK);
    for (int y = kBounds.y1; y < kBounds.y2; ++y) {
      for (int x = kBounds.x1; x < kBounds.x2; ++x) {
        if ((x + y) % 5 == 0) {
          EXPECT_EQ(output.bytes(x, y), source.bytes(x, y));
        } else {
          EXPECT_EQ(output.at(x, y), expected(testPixel(x, y)));
        }
      }
    }
  }
}

TEST_F(OfxImages, HalfSaturatesInsteadOfOverflowing) {
  Frame source({.bounds = {0, 0, 1, 1}, .depth = kOfxBitDepthHalf});
  source.fill([](int, int) { return Frame::Rgba{65504, 60000, 65504, 1}; });
  Frame output({.bounds = {0, 0, 1, 1}, .depth = kOfxBitDepthHalf});
  ASSERT_EQ(run(source, output, {0, 0, 1, 1}), kOfxStatOK);
  for (const float value : output.at(0, 0)) {
    EXPECT_TRUE(std::isfinite(value));
  }
  EXPECT_EQ(output.at(0, 0)[0], 65504);
}

}  // namespace
}  // namespace bare_host
