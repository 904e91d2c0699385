// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include "device_host.h"
#include "device_ledger.h"

namespace bare_host {

/// The plug-in before a host whose pictures lie on a device; what it calls is counted.
class OfxDevice : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!m_device.reason().empty()) {
      GTEST_SKIP() << m_device.reason() << ": renders in OpenCL buffers are not looked at; install pocl-opencl-icd";
    }
    useLibrary(m_words.library);
    *ledger() = {};
  }
  void TearDown() override { unsetenv(m_words.variable.c_str()); }

  void useLibrary(const std::string& name) const { setenv(m_words.variable.c_str(), name.c_str(), 1); }
  /// A host whose pictures lie on the device, and one before which an effect renders there.
  Features features() const { return {.device = m_words.kind}; }
  void onDevice(Instance& effect, int queue = 0) const { effect.useDevice(m_words.kind, m_device.queue(queue)); }

  DeviceLedger* ledger() const { return reinterpret_cast<DeviceLedgerFunction*>(m_ledger.symbol("metamerLedger"))(); }

  static Frame filled(const OfxRectI& bounds) {
    Frame frame({.bounds = bounds});
    frame.fill(testPixel);
    return frame;
  }

  /// A source and an output on the device, clips of an effect that renders there from now on.
  struct Pictures {
    Pictures(const OfxDevice& test, Instance& effect, const OfxRectI& bounds)
        : source(filled(bounds)), output({.bounds = bounds}), device(test.m_device) {
      effect.connect("Source", sourceThere.image());
      effect.connect("Output", outputThere.image());
      test.onDevice(effect);
    }
    Frame source;
    Frame output;
    const DeviceHost& device;
    const DeviceFrame sourceThere{device, source};
    const DeviceFrame outputThere{device, output};
  };
  /// What the processor draws of the same source, in memory.
  static void drawExpected(Instance& effect, Frame& expected) {
    const Frame source = filled(expected.shape().bounds);
    effect.connect("Source", source.image());
    effect.connect("Output", expected.image());
    ASSERT_EQ(draft(effect, expected.shape().bounds), kOfxStatOK);
  }

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
  void expectTheProcessorsBits(Instance& effect, const Case& given, const DeviceHost& device) {
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
    effect.useDevice("");
    connect(source.image(given.premultiplication), expected.image());
    ASSERT_EQ(effect.render(given.window, 0, given.field, {1, 1}, given.isDraft), kOfxStatOK);

    const DeviceFrame sourceThere(device, source, given.begin);
    const DeviceFrame outputThere(device, output, given.begin);
    std::unique_ptr<DeviceFrame> maskThere;
    if (given.mask != nullptr) {
      maskThere = std::make_unique<DeviceFrame>(device, *given.mask);
      effect.connect("Mask", maskThere->image());
    }
    connect(sourceThere.image(given.premultiplication), outputThere.image());
    effect.useDevice(m_words.kind, device.queue(given.queue));
    ASSERT_EQ(effect.render(given.window, 0, given.field, {1, 1}, given.isDraft), kOfxStatOK);
    effect.useDevice("");
    ASSERT_EQ(effect.effect().imagesOut, 0);
    EXPECT_TRUE(outputThere.bring(given.queue)) << "bytes beyond the image are written";
    EXPECT_TRUE(output.isGuardIntact());
    expectEqual(output, expected);
  }

  /// As many, none of them waited for; a device without doubles runs none.
  void expectKernels(int count) const {
    EXPECT_EQ(ledger()->kernels, m_words.hasDoubles ? count : 0);
    if (m_words.hasDoubles) {
      EXPECT_EQ(ledger()->waits, 0);
    }
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

  const std::unique_ptr<DeviceHost> m_host = makeDeviceHost();
  const DeviceHost& m_device = *m_host;
  const DeviceWords& m_words = m_host->words();
  LoadedLibrary m_ledger{m_words.library};
};

}  // namespace bare_host
