// SPDX-License-Identifier: Apache-2.0
// The map's fine table beside the patches that it stands for.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cstdio>
#include <random>

#include "metamer/sip/homogeneous_map.h"
#include "metamer/spectral/colorimetry.h"
#include "sip/transform/transform_fixture.h"

namespace metamer::sip {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using Map = HomogeneousMap;

/// Colours of surfaces: a light one of every kind, none at the gamut's border.
std::vector<float> surfaces(std::size_t count) {
  std::mt19937 random(7);
  std::vector<float> pixels;
  for (std::size_t i = 0; i < count; ++i) {
    for (int k = 0; k < 3; ++k) {
      pixels.push_back(static_cast<float>(0.15 + 0.85 * unitRandom(random)));
    }
    pixels.push_back(0.5F);
  }
  return pixels;
}

/// The same map without the table.
Map byPatchesAlone(Map map) {
  for (std::size_t i = 3; i < map.fine.size(); i += 4) {
    map.fine[i] = 1.0F;
  }
  return map;
}

TEST(FineTableTest, StaysWithinTheTolerance) {
  for (const auto& pair : {lightPairs()[1], lightPairs()[3]}) {
    const SpectralTransform transform(naturalSpecOf(pair.first, pair.second), 81);
    const Map map = buildHomogeneousMap(transform);
    const std::vector<float> pixels = surfaces(20'000);
    std::vector<float> fine(pixels.size());
    std::vector<float> exact(pixels.size());
    map.apply(pixels, fine);
    byPatchesAlone(map).apply(pixels, exact);
    const Eigen::Matrix3d& xyz = transform.space().xyzFromRgb();
    std::vector<double> errors;
    std::size_t same = 0;
    for (std::size_t i = 0; i < pixels.size(); i += 4) {
      const auto lab = [&](const std::vector<float>& rgba) {
        const double exposure = 0.18 / xyz.row(1).dot(Eigen::Map<const Vector3f>(pixels.data() + i).cast<double>());
        const Vector3d colour = exposure * Eigen::Map<const Vector3f>(rgba.data() + i).cast<double>();
        return spectral::lab(xyz * colour, transform.whiteXyz());
      };
      errors.push_back(spectral::deltaE2000(lab(fine), lab(exact)));
      same +=
          std::equal(fine.begin() + static_cast<std::ptrdiff_t>(i), fine.begin() + static_cast<std::ptrdiff_t>(i + 4),
                     exact.begin() + static_cast<std::ptrdiff_t>(i))
              ? 1
              : 0;
    }
    std::sort(errors.begin(), errors.end());
    const double p99 = errors[errors.size() * 99 / 100];
    const double left = static_cast<double>(same) / static_cast<double>(errors.size());
    std::printf("[ map ] %s: fine table beside patches p99 %.4f max %.4f; %.1f %% left to the patches\n",
                pairName(pair).c_str(), p99, errors.back(), 100.0 * left);
    // Checked in the middle of each cell, where a bilinear piece errs most but for what bends within the cell.
    EXPECT_LE(p99, 0.5 * kDefaultMapTolerance);
    EXPECT_LE(errors.back(), 1.5 * kDefaultMapTolerance);
    EXPECT_LE(left, 0.1) << "the table is there for these";
  }
}

TEST(FineTableTest, EveryCellIsWhatItsPatchIs) {
  // The last pair has patches far smaller than cells beside some that are larger.
  for (const auto& pair : {lightPairs()[1], lightPairs()[5]}) {
    const SpectralTransform transform(naturalSpecOf(pair.first, pair.second), 81);
    const Map map = buildHomogeneousMap(transform);
    const Eigen::Matrix3d rgbFromCube =
        Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(map.cubeFromRgb.data()).cast<double>().inverse();
    std::vector<float> pixels;
    for (int row = 0; row < Map::kFineSide; ++row) {
      for (int column = 0; column < Map::kFineSide; ++column) {
        for (const double within : {0.02, 0.5, 0.98}) {
          const auto place = [&](int cell) { return 2.0 * (cell + within) / Map::kFineSide - 1.0; };
          const Vector3d rgb = rgbFromCube * Vector3d(place(column), place(row), 1.0);
          pixels.insert(pixels.end(),
                        {static_cast<float>(rgb.x()), static_cast<float>(rgb.y()), static_cast<float>(rgb.z()), 1.0F});
        }
      }
    }
    std::vector<float> fine(pixels.size());
    std::vector<float> exact(pixels.size());
    map.apply(pixels, fine);
    byPatchesAlone(map).apply(pixels, exact);
    double largest = 0.0;
    for (std::size_t i = 0; i < pixels.size(); i += 4) {
      const Eigen::Map<const Vector3f> a(fine.data() + i);
      const Eigen::Map<const Vector3f> b(exact.data() + i);
      largest = std::max(largest, static_cast<double>((a - b).norm()));
    }
    std::printf("[ map ] %s: fine table and patches differ by at most %.2g of a pixel's length\n",
                pairName(pair).c_str(), largest);
    // What the tolerance lets pass where luminance is a fiftieth of the length, beyond all lights; a node that is not
    // its cell's own is off by tenths.
    EXPECT_LE(largest, 0.03) << pairName(pair);
    EXPECT_GT(largest, 0.0) << pairName(pair);
  }
}

TEST(FineTableTest, WhatItDoesNotHoldIsByPatchesToTheLastBit) {
  const SpectralTransform transform(naturalSpecOf("D65", "HP1"), 81);
  Map map = buildHomogeneousMap(transform, 0.3);
  const std::vector<float> pixels = surfaces(999);
  std::vector<float> exact(pixels.size());
  byPatchesAlone(map).apply(pixels, exact);
  std::vector<float> fine(pixels.size());
  map.apply(pixels, fine);
  // Every second cell is taken out: pixels keep the one value or take the other, whatever their neighbours do.
  for (std::size_t i = 3; i < map.fine.size(); i += 8) {
    map.fine[i] = 1.0F;
  }
  std::vector<float> mixed(pixels.size());
  map.apply(pixels, mixed);
  std::size_t ofExact = 0;
  for (std::size_t i = 0; i < pixels.size(); i += 4) {
    const auto at = static_cast<std::ptrdiff_t>(i);
    const bool isExact = std::equal(mixed.begin() + at, mixed.begin() + at + 4, exact.begin() + at);
    const bool isFine = std::equal(mixed.begin() + at, mixed.begin() + at + 4, fine.begin() + at);
    EXPECT_TRUE(isExact || isFine) << i / 4;
    ofExact += isExact && !isFine ? 1 : 0;
  }
  EXPECT_GT(ofExact, 300U);
  EXPECT_LT(ofExact, 700U);
}

}  // namespace
}  // namespace metamer::sip
