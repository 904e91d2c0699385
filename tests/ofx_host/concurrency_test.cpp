// SPDX-License-Identifier: Apache-2.0
// Renders at once, at random, and for a long time.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <thread>

#include "frame.h"

namespace bare_host {
namespace {

constexpr OfxRectI kBounds = {-5, 3, 123, 99};

TEST(OfxConcurrency, SixtyFourRendersOverEightInstancesAreBitEqualToSerial) {
  for (const int hostThreads : {0, 2}) {
    const Host host(builtLibrary(), {.threads = hostThreads});
    Frame source({.bounds = kBounds});
    source.fill(testPixel);
    std::vector<std::unique_ptr<Instance>> effects;
    const std::vector<std::string> lights = {"A", "HP1", "Blackbody", "FL11"};
    for (int i = 0; i < 8; ++i) {
      effects.push_back(host.create(0, {{"outputIlluminant", lights[static_cast<std::size_t>(i) % lights.size()]},
                                        {"scene", "Data set"},
                                        {"space", i % 3 == 2 ? "ACEScct" : "ACEScg"}}));
      effects.back()->animate("mix", [](double time) { return 1.0 - time / 10; });
      effects.back()->connect("Source", source.image());
    }
    // An instance has one output at a time: each renders at once with the seven others, eight times.
    const auto renderAll = [&](bool atOnce) {
      std::vector<Frame> frames(64, Frame({.bounds = kBounds}));
      for (int round = 0; round < 8; ++round) {
        std::vector<std::jthread> threads;
        for (std::size_t i = 0; i < effects.size(); ++i) {
          const Frame& frame = frames[static_cast<std::size_t>(round) * 8 + i];
          effects[i]->connect("Output", frame.image());
          const auto body = [&effect = *effects[i], round] { EXPECT_EQ(effect.render(kBounds, round), kOfxStatOK); };
          if (atOnce) {
            threads.emplace_back(body);
          } else {
            body();
          }
        }
      }
      return frames;
    };
    // At once first: the engines are built while others ask for them.
    const std::vector<Frame> concurrent = renderAll(true);
    const std::vector<Frame> serial = renderAll(false);
    for (std::size_t i = 0; i < serial.size(); ++i) {
      for (int y = kBounds.y1; y < kBounds.y2; ++y) {
        for (int x = kBounds.x1; x < kBounds.x2; ++x) {
          ASSERT_EQ(concurrent[i].bytes(x, y), serial[i].bytes(x, y));
        }
      }
    }
  }
}

TEST(OfxConcurrency, SixtyFourStripsOfOneFrameAtOnce) {
  const Host host(builtLibrary());
  const auto effect = host.create(0, {{"outputIlluminant", "LED-RGB1"}, {"scene", "Data set"}});
  Frame source({.bounds = kBounds});
  source.fill(testPixel);
  Frame whole({.bounds = kBounds});
  Frame strips({.bounds = kBounds});
  effect->connect("Source", source.image());
  effect->connect("Output", strips.image());
  {
    std::vector<std::jthread> threads;
    threads.reserve(64);
    for (int i = 0; i < 64; ++i) {
      threads.emplace_back([&, i] {
        const int width = (kBounds.x2 - kBounds.x1) / 64;
        const int x = kBounds.x1 + i * width;
        EXPECT_EQ(effect->render({x, kBounds.y1, x + width, kBounds.y2}), kOfxStatOK);
        EXPECT_EQ(effect->identity(kBounds), "");
      });
    }
  }
  effect->connect("Output", whole.image());
  ASSERT_EQ(effect->render(kBounds), kOfxStatOK);
  for (int y = kBounds.y1; y < kBounds.y2; ++y) {
    for (int x = kBounds.x1; x < kBounds.x2; ++x) {
      ASSERT_EQ(strips.bytes(x, y), whole.bytes(x, y));
    }
  }
}

/// Sets every parameter of an effect at random, within and now and then beyond its range.
void randomise(Instance& effect, std::mt19937& generator) {
  const auto below = [&](int count) { return static_cast<int>(generator() % static_cast<unsigned>(count)); };
  for (auto& [name, parameter] : effect.effect().parameters) {
    if (parameter->type == kOfxParamTypeChoice) {
      effect.set(name, below(parameter->properties.dimension(kOfxParamPropChoiceOption)));
    } else if (parameter->type == kOfxParamTypeBoolean) {
      effect.set(name, below(2));
    } else if (parameter->type == kOfxParamTypeDouble) {
      const bool isKelvin = name.find("Temperature") != std::string::npos;
      const double unit = static_cast<double>(generator()) / 4294967296.0;
      effect.set(name, below(50) == 0 ? -1.0 : isKelvin ? 1500 + 9000 * unit : unit * (below(5) == 0 ? 4 : 1));
    }
  }
  // A window of a few hundred pixels is soon solved. Maps take their time: seldom, and of an eye under a bare light: a
  // gel or a camera may hardly tell colours apart.
  if (below(12) != 0) {
    effect.set("quality", "Exact");
  } else {
    effect.set("inputFilter", "None");
    effect.set("inputObserver", "CIE 1931 2");
  }
}

TEST(OfxConcurrency, RandomParametersOnRandomWindows) {
  // METAMER_LONG=1: the ten thousand.
  const int count = std::getenv("METAMER_LONG") != nullptr ? 10000 : 100;
  std::mt19937 generator(2026);
  const Host host(builtLibrary(), {.threads = 2});
  const auto effect = host.create(0);
  const std::vector<std::string> depths = {kOfxBitDepthFloat, kOfxBitDepthHalf, kOfxBitDepthShort, kOfxBitDepthByte};
  const std::vector<std::string> components = {kOfxImageComponentRGBA, kOfxImageComponentRGB, kOfxImageComponentAlpha};
  const std::vector<const char*> premultiplications = {kOfxImageOpaque, kOfxImagePreMultiplied,
                                                       kOfxImageUnPreMultiplied};
  int transformed = 0;
  for (int i = 0; i < count; ++i) {
    const auto between = [&](int low, int high) {
      return low + static_cast<int>(generator() % static_cast<unsigned>(high - low + 1));
    };
    const auto shape = [&] {
      const int x = between(-20, 20);
      const int y = between(-20, 20);
      return Frame::Shape{.bounds = {x, y, x + between(0, 24), y + between(0, 12)},
                          .depth = depths[generator() % 4],
                          .components = components[generator() % 16 == 0 ? 2 : generator() % 2],
                          .padding = between(0, 9),
                          .topDown = generator() % 2 == 0};
    };
    randomise(*effect, generator);
    Frame source(shape());
    source.fill(testPixel);
    Frame output(shape());
    Frame mask({.bounds = shape().bounds, .components = kOfxImageComponentAlpha});
    mask.fill(testPixel);
    effect->connect("Source", source.image(premultiplications[generator() % 3]));
    effect->connect("Output", output.image());
    effect->clip("Mask").isConnected = false;
    effect->clip("Mask").properties.set(kOfxImageClipPropConnected, 0);
    if (generator() % 3 == 0) {
      effect->connect("Mask", mask.image());
    }
    const OfxRectI window = shape().bounds;
    effect->identity(window, i);
    ASSERT_EQ(effect->render(window, i), kOfxStatOK) << i;
    ASSERT_EQ(effect->effect().imagesOut, 0);
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
  std::printf("%d parameter sets, %d of them transform\n", count, transformed);
  EXPECT_GT(transformed, count / 3) << "most parameter sets have a meaning";
}

TEST(OfxConcurrency, MemoryStaysFlatOverAThousandFrames) {
  if (!residentMemoryIsMeasurable()) {
    GTEST_SKIP() << "a sanitizer keeps what is freed";
  }
  const Host host(builtLibrary());
  const auto effect = host.create(0, {{"outputIlluminant", "HP1"}, {"scene", "Data set"}});
  effect->animate("mix", [](double time) { return std::fmod(time, 10) / 10; });
  Frame source({.bounds = kBounds});
  source.fill(testPixel);
  Frame output({.bounds = kBounds});
  effect->connect("Source", source.image());
  effect->connect("Output", output.image());
  const auto renderFrames = [&](int first, int count) {
    for (int frame = first; frame < first + count; ++frame) {
      ASSERT_EQ(effect->render(kBounds, frame), kOfxStatOK);
    }
  };
  renderFrames(0, 50);
  const std::size_t before = residentBytes();
  renderFrames(50, 1000);
  const std::size_t after = residentBytes();
  std::printf("resident: %.2f MiB after 50 frames, %.2f MiB after 1,050\n", static_cast<double>(before) / (1U << 20U),
              static_cast<double>(after) / (1U << 20U));
  EXPECT_LT(after, before + (1U << 20U));
}

TEST(OfxConcurrency, MemoryIsBoundedWhileALightIsAnimated) {
  if (!residentMemoryIsMeasurable()) {
    GTEST_SKIP() << "a sanitizer keeps what is freed";
  }
  const Host host(builtLibrary());
  // Exact: an engine a frame, without the time that maps take.
  const auto effect = host.create(0, {{"outputIlluminant", "Blackbody"}, {"quality", "Exact"}});
  effect->animate("outputTemperature", [](double time) { return 2000 + time; });
  Frame source({.bounds = {0, 0, 8, 8}});
  source.fill(testPixel);
  Frame output({.bounds = {0, 0, 8, 8}});
  effect->connect("Source", source.image());
  effect->connect("Output", output.image());
  const auto renderFrames = [&](int first, int count) {
    for (int frame = first; frame < first + count; ++frame) {
      ASSERT_EQ(effect->render({0, 0, 8, 8}, frame), kOfxStatOK);
    }
  };
  renderFrames(0, 60);
  const std::size_t before = residentBytes();
  renderFrames(60, 400);
  EXPECT_LT(residentBytes(), before + (4U << 20U));
}

}  // namespace
}  // namespace bare_host
