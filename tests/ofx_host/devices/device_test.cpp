// SPDX-License-Identifier: Apache-2.0
// Renders where the host keeps its images on a device: the processor's bits, and no waiting.
#include <chrono>
#include <fstream>
#include <future>
#include <limits>
#include <random>

#include "device_fixture.h"
#include "scratch_folder.h"

namespace bare_host {
namespace {

constexpr OfxRectI kBounds = {-7, 11, 58, 40};
constexpr OfxRectI kLarger = {-20, 0, 70, 55};
const std::map<std::string, Properties::Value> kLamp = {{"outputIlluminant", "HP1"}, {"adaptation", 0.3}};

std::string stageIn(const ScratchFolder& folder) {
  const auto file = folder.path() / "stage.json";
  std::ofstream(file) << R"({"metamer_stage": 1, "M": [[1.51, -0.25, 0.03], [-0.123, 1.25, -0.0625], [0.07, -0.5, 2.1]],
    "Q": [[1.01, 0.5, 0.3], [0.1, 1.0, 0.2], [0.05, 0.25, 1.0]], "N": [[0.5, 0.25, 0.1], [0.03, 1.0, 0.25], [0.125, 0.1, 0.75]],
    "offset": [-0.01, -0.02, -0.005]})";
  return textOf(file);
}

TEST_F(OfxDevice, EveryShapeOfMemoryGivesTheProcessorsBits) {
  const Host host(builtLibrary(), features());
  const auto effect = host.create(0, kLamp);
  for (const bool topDown : {false, true}) {
    for (const int padding : {0, 4, 20}) {
      for (const char* const components : {kOfxImageComponentRGBA, kOfxImageComponentRGB}) {
        for (const char* const depth : {kOfxBitDepthFloat, kOfxBitDepthHalf}) {
          SCOPED_TRACE(std::string(depth) + " " + components + " padding " + std::to_string(padding));
          const Frame::Shape source{kLarger, depth, components, padding, topDown};
          const Frame::Shape output{kBounds, depth, components, 2 * padding, !topDown};
          expectTheProcessorsBits(*effect, {.source = source, .output = output, .window = kBounds});
        }
      }
    }
  }
  // Formats that differ, windows within, pictures that end within the window, parts of larger buffers.
  const Frame::Shape half{{0, 15, 30, 30}, kOfxBitDepthHalf, kOfxImageComponentRGB, 2};
  expectTheProcessorsBits(*effect, {.source = half, .output = {kBounds}, .window = kBounds});
  expectTheProcessorsBits(*effect, {.source = {kLarger}, .output = half, .window = {5, 17, 22, 29}});
  expectTheProcessorsBits(
      *effect, {.source = {kLarger}, .output = {kBounds}, .window = kBounds, .begin = m_device.partAlignment()});
  for (const char* const field : {kOfxImageFieldLower, kOfxImageFieldUpper}) {
    expectTheProcessorsBits(*effect, {.source = {kLarger}, .output = {kBounds}, .window = kBounds, .field = field});
  }
  // Beyond a half's range, below a float's, and no number at all.
  for (const float gain : {1e4F, 1e-41F, std::numeric_limits<float>::infinity()}) {
    for (const char* const depth : {kOfxBitDepthFloat, kOfxBitDepthHalf}) {
      expectTheProcessorsBits(*effect,
                              {.source = {kLarger}, .output = {kBounds, depth}, .window = kBounds, .gain = gain});
    }
  }
  EXPECT_EQ(ledger()->waits, 0);
  EXPECT_EQ(ledger()->kernels, 24 + 5 + 6);
}

TEST_F(OfxDevice, MaskMixAndPassingThrough) {
  const Host host(builtLibrary(), features());
  const auto effect = host.create(0, kLamp);
  const Case whole{.source = {kLarger}, .output = {kBounds}, .window = kBounds};
  Frame mask({{0, 5, 50, 30}, kOfxBitDepthFloat, kOfxImageComponentAlpha, 8, true});
  mask.fill(testPixel);
  Frame halfMask({{0, 5, 50, 30}, kOfxBitDepthHalf, kOfxImageComponentAlpha});
  halfMask.fill(testPixel);
  for (const double mix : {0.0, 0.3, 1.0}) {
    effect->set("mix", mix);
    for (const Frame* const matte : std::initializer_list<const Frame*>{nullptr, &mask, &halfMask}) {
      for (const char* const premultiplication : {kOfxImagePreMultiplied, kOfxImageOpaque}) {
        Case given = whole;
        given.mask = matte;
        given.premultiplication = premultiplication;
        expectTheProcessorsBits(*effect, given);
      }
    }
  }
  // Nothing to do: pixels pass, code for code.
  effect->set("outputIlluminant", "D65");
  expectTheProcessorsBits(*effect, whole);
  const Frame::Shape half{kBounds, kOfxBitDepthHalf};
  expectTheProcessorsBits(*effect, {.source = half, .output = half, .window = kBounds});
  EXPECT_EQ(ledger()->waits, 0);
}

TEST_F(OfxDevice, WhatNoKernelDoesIsReadBack) {
  const Host host(builtLibrary(), features());
  const auto effect = host.create(0, kLamp);
  // Whole numbers; rows off their alignment; pixel by pixel.
  const Frame::Shape codes{kLarger, kOfxBitDepthByte, kOfxImageComponentRGBA, 5, true};
  expectTheProcessorsBits(*effect, {.source = codes, .output = {kBounds}, .window = {0, 12, 40, 30}});
  expectTheProcessorsBits(*effect,
                          {.source = {kLarger}, .output = codes, .window = kBounds, .field = kOfxImageFieldUpper});
  const Frame::Shape odd{kBounds, kOfxBitDepthHalf, kOfxImageComponentRGB, 3};
  expectTheProcessorsBits(*effect, {.source = odd, .output = odd, .window = kBounds});
  effect->set("quality", "Exact");
  expectTheProcessorsBits(*effect, {.source = {kLarger}, .output = {kBounds}, .window = kBounds});
  EXPECT_EQ(ledger()->kernels, 0);
  EXPECT_EQ(effect->message(), "");
}

TEST_F(OfxDevice, OneBufferForBothIsRight) {
  const Host host(builtLibrary(), features());
  const auto effect = host.create(0, kLamp);
  Frame frame({.bounds = kLarger});
  frame.fill(testPixel);
  Frame expected({.bounds = kLarger});
  effect->connect("Source", frame.image());
  effect->connect("Output", expected.image());
  ASSERT_EQ(draft(*effect, kLarger), kOfxStatOK);
  onDevice(*effect);
  {
    const DeviceFrame there(m_device, frame);
    effect->connect("Source", there.image());
    effect->connect("Output", there.image());
    ASSERT_EQ(draft(*effect, kLarger), kOfxStatOK);
    Frame before = frame;
    EXPECT_TRUE(there.bring());
    expectEqual(frame, expected);
    EXPECT_EQ(ledger()->kernels, 1);
    frame = before;
  }
  // The same rows, upside down: a kernel would read what it has written.
  const DeviceFrame there(m_device, frame);
  effect->connect("Source", there.image());
  effect->connect("Output", there.turnedImage());
  ASSERT_EQ(draft(*effect, kLarger), kOfxStatOK);
  EXPECT_TRUE(there.bring());
  EXPECT_EQ(ledger()->kernels, 1);
  for (int x = kLarger.x1; x < kLarger.x2; ++x) {
    EXPECT_EQ(frame.bytes(x, kLarger.y2 - 1), expected.bytes(x, kLarger.y1));
  }
}

TEST_F(OfxDevice, ReturnsBeforeTheHostLetsItsQueueRun) {
  const Host host(builtLibrary(), features());
  const auto effect = host.create(0, kLamp);
  Frame expected({.bounds = kBounds});
  drawExpected(*effect, expected);
  const Pictures pictures(*this, *effect, kBounds);
  void* const event = m_device.hold();
  auto rendered = std::async(std::launch::async, [&] { return draft(*effect, kBounds); });
  const bool hasReturned = rendered.wait_for(std::chrono::seconds(20)) == std::future_status::ready;
  m_device.signal(event);
  EXPECT_TRUE(hasReturned);
  ASSERT_EQ(rendered.get(), kOfxStatOK);
  EXPECT_TRUE(pictures.outputThere.bring());
  expectEqual(pictures.output, expected);
}

TEST_F(OfxDevice, BuildsOnceAndUploadsOnceAMap) {
  const DeviceLedger* const seen = ledger();
  Case whole{.source = {kLarger}, .output = {kBounds}, .window = kBounds, .isDraft = false};
  {
    const Host host(builtLibrary(), features());
    const auto effect = host.create(0, kLamp);
    const auto other = host.create(0, kLamp);
    for (const int queue : {0, 1, 0}) {
      whole.queue = queue;
      expectTheProcessorsBits(*effect, whole);
      expectTheProcessorsBits(*other, whole);
    }
    EXPECT_EQ(seen->programs, 1);
    EXPECT_EQ(seen->uploads, 2) << "nodes and cells, for both queues and instances";
    // Another context, and another light, have tables of their own.
    const auto second = makeDeviceHost();
    expectTheProcessorsBits(*effect, whole, *second);
    EXPECT_EQ(seen->programs, 2);
    EXPECT_EQ(seen->buffers, 4);
    effect->set("outputIlluminant", "A");
    whole.isDraft = true;
    expectTheProcessorsBits(*effect, whole);
    EXPECT_EQ(seen->buffers, 6);
    // Lights that are put out of the plug-in's cache have none.
    effect->set("quality", "Exact");
    effect->set("outputIlluminant", "Blackbody");
    for (int k = 0; k < 30; ++k) {
      effect->set("outputTemperature", 3000.0 + k);
      ASSERT_EQ(effect->identity(kBounds), "");
    }
    EXPECT_EQ(seen->buffers, 0) << "tables of lights that are long gone";
  }
  EXPECT_EQ(seen->programs, 2);
  EXPECT_EQ(seen->released, 2);
  EXPECT_EQ(seen->waits, 0);
}

TEST_F(OfxDevice, SkinGivesTheProcessorsBits) {
  const Host host(builtLibrary(), features());
  const auto effect = host.create(2, {{"melanin", 1.6}, {"flush", 0.5}});
  Frame mask({kBounds, kOfxBitDepthFloat, kOfxImageComponentAlpha});
  mask.fill(testPixel);
  for (const char* const depth : {kOfxBitDepthFloat, kOfxBitDepthHalf}) {
    expectTheProcessorsBits(*effect, {.source = {kLarger, depth}, .output = {kBounds, depth}, .window = kBounds});
    expectTheProcessorsBits(*effect,
                            {.source = {kLarger, depth}, .output = {kBounds, depth}, .mask = &mask, .window = kBounds});
  }
  effect->set("matte", 0);
  expectTheProcessorsBits(*effect, {.source = {kLarger}, .output = {kBounds}, .window = kBounds});
  EXPECT_EQ(ledger()->waits, 0);
}

TEST_F(OfxDevice, LogSpacesGiveTheProcessorsBits) {
  const Host host(builtLibrary(), features());
  const auto effect = host.create(0, kLamp);
  const auto skin = host.create(2, {{"melanin", 1.6}, {"space", "S-Log3 S-Gamut3"}});
  // Signals; light that is far beyond them, below them, and none.
  const std::vector<std::pair<float, const char*>> kinds = {
      {1.0F, kOfxImageOpaque},
      {1.0F, kOfxImagePreMultiplied},
      {3.0F, kOfxImagePreMultiplied},
      {1e-9F, kOfxImageOpaque},
      {std::numeric_limits<float>::infinity(), kOfxImagePreMultiplied}};
  for (const auto& [gain, premultiplication] : kinds) {
    const Case given{.source = {kLarger},
                     .output = {kBounds},
                     .window = kBounds,
                     .premultiplication = premultiplication,
                     .gain = gain};
    for (const char* const space :
         {"ACEScct", "ARRI LogC3", "ARRI LogC4", "S-Log3 S-Gamut3", "V-Log V-Gamut", "Log3G10 REDWideGamutRGB",
          "Canon Log 2 Cinema Gamut", "Canon Log 3 Cinema Gamut", "DaVinci Intermediate"}) {
      SCOPED_TRACE(std::string(space) + ", gain " + std::to_string(gain));
      effect->set("space", space);
      expectTheProcessorsBits(*effect, given);
    }
    expectTheProcessorsBits(*skin, given);
  }
  EXPECT_EQ(effect->message(), "");
  expectKernels(5 * 10);
}

TEST_F(OfxDevice, StagesGiveTheProcessorsBits) {
  const ScratchFolder folder;
  const Host host(builtLibrary(), features());
  const auto effect = host.create(1, {{"stageFile", stageIn(folder)}});
  const int operations = effect->effect().parameters.at("operation")->properties.dimension(kOfxParamPropChoiceOption);
  const int curves = effect->effect().parameters.at("curve")->properties.dimension(kOfxParamPropChoiceOption);
  int rendered = 0;
  for (int curve = 0; curve < curves; ++curve) {
    for (int operation = 0; operation < operations; ++operation) {
      SCOPED_TRACE(std::to_string(curve) + ", " + std::to_string(operation));
      effect->set("curve", curve);
      effect->set("operation", operation);
      effect->set("direction", rendered % 2);
      const Case given{.source = {kLarger},
                       .output = {kBounds, rendered % 3 == 0 ? kOfxBitDepthHalf : kOfxBitDepthFloat},
                       .window = kBounds,
                       .premultiplication = rendered % 4 < 2 ? kOfxImagePreMultiplied : kOfxImageOpaque};
      expectTheProcessorsBits(*effect, given);
      ++rendered;
    }
  }
  EXPECT_EQ(effect->message(), "");
  EXPECT_EQ(ledger()->buffers, 0);
  expectKernels(rendered);
}

TEST_F(OfxDevice, EveryKernelOnSmallFrames) {
  // Also run by test_opencl_races.py, which is slow.
  const Host host(builtLibrary(), features());
  const Frame::Shape shape{{0, 0, 11, 3}, kOfxBitDepthHalf, kOfxImageComponentRGB, 4, true};
  Frame mask({{2, -1, 9, 3}, kOfxBitDepthFloat, kOfxImageComponentAlpha});
  mask.fill(testPixel);
  Case given{.source = shape, .output = {{1, 0, 14, 3}}, .mask = &mask, .window = {0, 0, 14, 3}};
  const auto effect = host.create(0, kLamp);
  const auto skin = host.create(2, {{"melanin", 1.6}});
  for (const char* const space : {"ACEScg", "ACEScct"}) {
    effect->set("space", space);
    skin->set("space", space);
    expectTheProcessorsBits(*effect, given);
    expectTheProcessorsBits(*skin, given);
  }
  effect->set("mix", 0.0);
  expectTheProcessorsBits(*effect, given);
  const ScratchFolder folder;
  expectTheProcessorsBits(*host.create(1, {{"stageFile", stageIn(folder)}}), given);
  EXPECT_EQ(ledger()->kernels, m_words.hasDoubles ? 6 : 3);
}

TEST_F(OfxDevice, RandomParameters) {
  // METAMER_LONG=1: the thousand.
  const int count = std::getenv("METAMER_LONG") != nullptr ? 1000 : 12;
  std::mt19937 generator(22);
  const auto below = [&](int most) { return static_cast<int>(generator() % static_cast<unsigned>(most)); };
  const auto share = [&] { return static_cast<double>(generator()) / 4294967296.0; };
  const Host host(builtLibrary(), features());
  const auto effect = host.create(0);
  for (int i = 0; i < count && !HasFatalFailure(); ++i) {
    SCOPED_TRACE(i);
    for (auto& [name, parameter] : effect->effect().parameters) {
      if (parameter->type == kOfxParamTypeChoice) {
        effect->set(name, below(parameter->properties.dimension(kOfxParamPropChoiceOption)));
      } else if (parameter->type == kOfxParamTypeBoolean) {
        effect->set(name, below(2));
      } else if (parameter->type == kOfxParamTypeDouble) {
        effect->set(name, name.find("Temperature") != std::string::npos ? 1500 + 9000 * share() : share());
      }
    }
    // What a kernel does, most of the time; drafts, whose maps are soon made.
    if (below(6) != 0) {
      effect->set("space", "Rec.2020");
      effect->set("scene", "Natural");
    }
    effect->set("inputFilter", "None");
    effect->set("inputObserver", "CIE 1931 2");
    effect->set("quality", below(10) == 0 ? "Exact" : "Map");
    const auto shape = [&] {
      const int x = below(20) - 20;
      const int y = below(12) - 12;
      return Frame::Shape{.bounds = {x, y, x + below(70), y + below(30)},
                          .depth = below(2) == 0 ? kOfxBitDepthFloat : kOfxBitDepthHalf,
                          .components = below(8) == 0   ? kOfxImageComponentAlpha
                                        : below(2) == 0 ? kOfxImageComponentRGB
                                                        : kOfxImageComponentRGBA,
                          .padding = 4 * below(3),
                          .topDown = below(2) == 0};
    };
    Frame mask({.bounds = shape().bounds, .components = kOfxImageComponentAlpha});
    mask.fill(testPixel);
    expectTheProcessorsBits(*effect, {.source = shape(),
                                      .output = shape(),
                                      .mask = below(3) == 0 ? &mask : nullptr,
                                      .window = shape().bounds,
                                      .premultiplication = below(2) == 0 ? kOfxImagePreMultiplied : kOfxImageOpaque,
                                      .isDraft = below(8) != 0,
                                      .queue = below(2)});
  }
  std::printf("%d parameter sets, %d of them by a kernel\n", count, ledger()->kernels);
  EXPECT_GT(ledger()->kernels, count / (m_words.hasDoubles ? 4 : 6));
}

}  // namespace
}  // namespace bare_host
