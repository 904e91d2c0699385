// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include "opencl_host.h"
#include "opencl_ledger.h"

namespace bare_host {

/// The plug-in before a host with OpenCL buffers; what it calls is counted.
class OfxOpenCl : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!m_device.reason().empty()) {
      GTEST_SKIP() << m_device.reason() << ": renders in OpenCL buffers are not looked at; install pocl-opencl-icd";
    }
    setenv("METAMER_OFX_OPENCL", METAMER_OPENCL_LEDGER, 1);
    *ledger() = {};
  }
  void TearDown() override { unsetenv("METAMER_OFX_OPENCL"); }

  OpenClLedger* ledger() const { return reinterpret_cast<OpenClLedgerFunction*>(m_ledger.symbol("metamerLedger"))(); }

  /// Renders the frames in memory, then in buffers, and expects the same bytes, in and around the pixels.
  struct Case {
    Frame::Shape source;
    Frame::Shape output;
    const Frame* mask = nullptr;
    OfxRectI window{};
    std::string premultiplication = kOfxImageUnPreMultiplied;
    std::string field = kOfxImageFieldNone;
    std::size_t begin = 0;  ///< in larger buffers, from this byte on
    bool isDraft = true;    ///< their maps are soon made
    int queue = 0;
    float gain = 1.0F;  ///< of the source's colours
  };
  void expectTheProcessorsBits(Instance& effect, const Case& given) {
    expectTheProcessorsBits(effect, given, m_device);
  }
  void expectTheProcessorsBits(Instance& effect, const Case& given, const OpenClHost& device) {
    Frame source(given.source);
    source.fill([&](int x, int y) {
      const Frame::Rgba pixel = testPixel(x, y);
      return Frame::Rgba{given.gain * pixel[0], given.gain * pixel[1], given.gain * pixel[2], pixel[3]};
    });
    Frame expected(given.output);
    expected.fill(testPixel);
    Frame output = expected;
    const auto connect = [&](const Image& sourceImage, const Image& outputImage) {
      effect.connect("Source", sourceImage);
      effect.connect("Output", outputImage);
    };
    if (given.mask != nullptr) {
      effect.connect("Mask", given.mask->image());
    } else {
      effect.clip("Mask").isConnected = false;
      effect.clip("Mask").properties.set(kOfxImageClipPropConnected, 0);
    }
    effect.useOpenCl(nullptr);
    connect(source.image(given.premultiplication), expected.image());
    ASSERT_EQ(effect.render(given.window, 0, given.field, {1, 1}, given.isDraft), kOfxStatOK);

    const OpenClFrame sourceThere(device, source, given.begin);
    const OpenClFrame outputThere(device, output, given.begin);
    std::unique_ptr<OpenClFrame> maskThere;
    if (given.mask != nullptr) {
      maskThere = std::make_unique<OpenClFrame>(device, *given.mask);
      effect.connect("Mask", maskThere->image());
    }
    connect(sourceThere.image(given.premultiplication), outputThere.image());
    effect.useOpenCl(device.queue(given.queue));
    ASSERT_EQ(effect.render(given.window, 0, given.field, {1, 1}, given.isDraft), kOfxStatOK);
    effect.useOpenCl(nullptr);
    ASSERT_EQ(effect.effect().imagesOut, 0);
    EXPECT_TRUE(outputThere.bring(given.queue)) << "bytes beyond the image are written";
    EXPECT_TRUE(output.isGuardIntact());
    expectEqual(output, expected);
  }

  static OfxStatus draft(const Instance& effect, const OfxRectI& window) {
    return effect.render(window, 0, kOfxImageFieldNone, {1, 1}, true);
  }

  static void expectEqual(const Frame& given, const Frame& expected) {
    const OfxRectI& bounds = expected.shape().bounds;
    for (int y = bounds.y1; y < bounds.y2; ++y) {
      for (int x = bounds.x1; x < bounds.x2; ++x) {
        ASSERT_EQ(given.bytes(x, y), expected.bytes(x, y))
            << x << " " << y << ": " << ::testing::PrintToString(given.at(x, y)) << " for "
            << ::testing::PrintToString(expected.at(x, y));
      }
    }
  }

  OpenClHost m_device;
  LoadedLibrary m_ledger{METAMER_OPENCL_LEDGER};
};

}  // namespace bare_host
