// SPDX-License-Identifier: Apache-2.0
// What only Metal does: arithmetic that is fast unless one says not, objects that are counted, errors that come later.
#include "device_fixture.h"
#include "metal_runtime.h"

namespace bare_host {
namespace {

constexpr OfxRectI kBounds = {0, 0, 133, 20};

class OfxMetal : public OfxDevice {
 protected:
  MetalRuntime& runtime() const { return *reinterpret_cast<MetalRuntimeFunction*>(m_ledger.symbol("metamerMetal"))(); }
  void TearDown() override {
    runtime().hasFailed = false;
    OfxDevice::TearDown();
  }
};

TEST_F(OfxMetal, AThreadgroupLiesAlongARow) {
  const Host host(builtLibrary(), features());
  expectTheProcessorsBits(*host.create(0, {{"outputIlluminant", "HP1"}}),
                          {.source = {kBounds}, .output = {kBounds}, .window = kBounds});
  EXPECT_EQ(runtime().group[0] * runtime().group[1] * runtime().group[2], 64U);
  EXPECT_EQ(runtime().grid[0], 3U);
  EXPECT_EQ(runtime().grid[1], 20U);
}

TEST_F(OfxMetal, EveryObjectIsLetGo) {
  const int before = runtime().objects;
  {
    const Host host(builtLibrary(), features());
    const auto effect = host.create(0, {{"outputIlluminant", "HP1"}});
    for (const char* const quality : {"Map", "Exact"}) {
      effect->set("quality", quality);
      expectTheProcessorsBits(*effect, {.source = {kBounds, kOfxBitDepthHalf, kOfxImageComponentRGB},
                                        .output = {{1, 1, 132, 19}, kOfxBitDepthHalf, kOfxImageComponentRGB, 2},
                                        .window = {4, 3, 81, 17}});
    }
    ledger()->refused = "newLibraryWithSource:";
    const auto second = makeDeviceHost();
    expectTheProcessorsBits(*host.create(0, {{"outputIlluminant", "A"}}),
                            {.source = {kBounds}, .output = {kBounds}, .window = kBounds}, *second);
    ledger()->refused = nullptr;
  }
  EXPECT_EQ(runtime().objects, before);
}

TEST_F(OfxMetal, WhatFailsOnTheDeviceIsForTheHostToDoWithout) {
  const Host host(builtLibrary(), features());
  const auto effect = host.create(0, {{"outputIlluminant", "HP1"}, {"quality", "Exact"}});
  Frame source({.bounds = kBounds});
  const DeviceFrame there(m_device, source);
  effect->connect("Source", there.image());
  effect->connect("Output", there.image());
  onDevice(*effect);
  runtime().hasFailed = true;
  EXPECT_EQ(draft(*effect, kBounds), 1002);
}

}  // namespace
}  // namespace bare_host
