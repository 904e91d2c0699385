// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/chromaticity_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "sip/device/device_fixture.h"

namespace metamer::sip {
namespace {

const DeviceCase& sodium() {
  return deviceCases()[6];
}

std::vector<float> throughGrid(const ChromaticityGrid& grid, std::vector<float> pixels) {
  applyChromaticityGrid(grid, pixels);
  return pixels;
}

TEST(ChromaticityGridTest, IsNearTheMapAtAnyExposure) {
  for (const DeviceCase& each : deviceCases()) {
    const std::vector<float> pixels = pixelsOfEveryKind(20'000, 23);
    std::vector<float> expected(pixels.size());
    each.map.apply(pixels, expected);
    const std::vector<float> given = throughGrid(chromaticityGrid(each.map), pixels);
    std::vector<double> off;
    for (std::size_t i = 0; i < pixels.size(); i += 4) {
      const float size = std::max({std::abs(pixels[i]), std::abs(pixels[i + 1]), std::abs(pixels[i + 2])});
      const bool isFinite = std::isfinite(pixels[i] + pixels[i + 1] + pixels[i + 2]) && size < 1e36F;
      double largest = 0.0;
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_TRUE(!isFinite || std::isfinite(given[i + k])) << each.name << ", pixel " << i / 4;
        largest = std::max(largest, static_cast<double>(std::abs(given[i + k] - expected[i + k])));
      }
      // Surfaces and lights: what lies beyond them goes through the matrix.
      if (isFinite && size > 1e-30F && i / 4 % 4 < 2 && i / 4 % 16 != 5) {
        off.push_back(largest / size);
      }
      EXPECT_EQ(given[i + 3], pixels[i + 3]);
    }
    std::sort(off.begin(), off.end());
    std::printf("[ grid ] %s: off by %.2g of a pixel's size at p99, %.2g at most\n", each.name.c_str(),
                off[off.size() * 99 / 100], off.back());
    // A hundredth of a CIEDE2000 or so, beside which the map's own tenth is what counts.
    EXPECT_LE(off[off.size() * 99 / 100], 2e-4) << each.name;
  }
}

TEST(ChromaticityGridTest, WhatIsNoColourStays) {
  const float nan = std::nanf("");
  const std::vector<float> pixels = {nan, 1.0F, 2.0F, 0.5F, 1.0F, -INFINITY, 2.0F, 0.25F, 0.0F, 0.0F, 0.0F, 1.0F};
  const std::vector<float> given = throughGrid(chromaticityGrid(sodium().map), pixels);
  std::string first;
  EXPECT_EQ(differingBits(std::span(pixels).first(8), std::span(given).first(8), first), 0U) << first;
  EXPECT_EQ(given[8], 0.0F);
  std::vector<float> half(6);
  EXPECT_THROW(applyChromaticityGrid(chromaticityGrid(sodium().map), half), std::exception);
}

TEST(ChromaticityGridTest, TheTextHoldsTheGridToTheBit) {
  const ChromaticityGrid grid = chromaticityGrid(deviceCases()[0].map);
  const std::string text = dctlText(grid);
  const std::size_t table = text.find("LUT_3D_SIZE 65\n");
  ASSERT_NE(table, std::string::npos);
  const char* at = text.c_str() + table + 15;
  for (const auto& node : grid.nodes) {
    for (const float value : node) {
      char* end = nullptr;
      ASSERT_EQ(std::strtof(at, &end), value);
      ASSERT_TRUE(value >= 0.0F && value <= 1.0F);
      at = end;
    }
  }
  const char* number = text.c_str() + text.find("metamerNumbers[] = {") + 20;
  for (const float value : grid.numbers) {
    char* end = nullptr;
    ASSERT_EQ(std::strtof(number, &end), value);
    number = end + 2;  // "f,"
  }
}

}  // namespace
}  // namespace metamer::sip
