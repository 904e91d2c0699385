// SPDX-License-Identifier: Apache-2.0
// Drafts: what a host asks for while a slider is drawn.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "frame.h"

namespace bare_host {
namespace {

constexpr OfxRectI kBounds = {0, 0, 128, 96};

/// Colours as of a photograph: every hue, to half of its gamut, over ten stops.
Frame::Rgba surface(int x, int y) {
  const double hue = 2 * M_PI * x / 128;
  const double chroma = 0.5 * (y % 12) / 11;
  const double light = 0.9 * std::exp2(-10.0 * y / 96);
  const auto channel = [&](double phase) {
    return static_cast<float>(light * (1 - chroma + chroma * std::cos(hue + phase)));
  };
  return {channel(0), channel(2.1), channel(4.2), 1.0F};
}

/// The frame's bytes, and largest difference of two over the pixel's own size, 99th percentile.
std::vector<std::string> bytesOf(const Frame& frame) {
  std::vector<std::string> bytes;
  for (int y = kBounds.y1; y < kBounds.y2; ++y) {
    for (int x = kBounds.x1; x < kBounds.x2; ++x) {
      bytes.push_back(frame.bytes(x, y));
    }
  }
  return bytes;
}

double relativeDifference99(const Frame& a, const Frame& b) {
  std::vector<double> differences;
  for (int y = kBounds.y1; y < kBounds.y2; ++y) {
    for (int x = kBounds.x1; x < kBounds.x2; ++x) {
      const Frame::Rgba one = a.at(x, y);
      const Frame::Rgba other = b.at(x, y);
      double largest = 0;
      double size = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        largest = std::max(largest, std::abs(static_cast<double>(one[k]) - static_cast<double>(other[k])));
        size = std::max(size, std::abs(static_cast<double>(one[k])));
      }
      differences.push_back(largest / size);
    }
  }
  std::sort(differences.begin(), differences.end());
  return differences[differences.size() * 99 / 100];
}

TEST(OfxDraft, IsNearTheFinalFrameAndLeavesItAlone) {
  const Host host(builtLibrary(), {.threads = 2});
  Frame source({.bounds = kBounds});
  source.fill(surface);
  for (const char* const light : {"A", "HP1", "LED-RGB1"}) {
    const auto effect = host.create(0, {{"outputIlluminant", light}});
    effect->connect("Source", source.image());
    const auto rendered = [&](double adaptation, bool isDraft) {
      effect->set("adaptation", adaptation);
      Frame output({.bounds = kBounds});
      effect->connect("Output", output.image());
      EXPECT_EQ(effect->render(kBounds, 0, kOfxImageFieldNone, {1, 1}, isDraft), kOfxStatOK);
      return output;
    };
    const Frame draft = rendered(0.75, true);
    const Frame final = rendered(0.75, false);
    const double difference = relativeDifference99(final, draft);
    std::printf("[ draft ] %s: p99 %.4f of a pixel's size\n", light, difference);
    EXPECT_LE(difference, 0.02) << light;
    EXPECT_FALSE(bytesOf(draft) == bytesOf(final)) << light;
    // Where the final map is there, it is as quick.
    EXPECT_TRUE(bytesOf(rendered(0.75, true)) == bytesOf(final)) << light;
    // A final frame is the same whether drafts went before or not: the memory of drafts is their own.
    const Frame without = rendered(0.5, false);
    rendered(0.75, true);
    rendered(0.7, true);
    EXPECT_TRUE(bytesOf(rendered(0.5, false)) == bytesOf(without)) << light;
  }
}

}  // namespace
}  // namespace bare_host
