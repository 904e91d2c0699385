// SPDX-License-Identifier: Apache-2.0
#include "metamer/skin/layered_albedo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "metamer/skin/random_walk.h"
#include "metamer/skin/skin_model.h"
#include "spectral/fixture.h"

namespace metamer::skin {
namespace {

using spectral::MaxDifference;
using spectral::testLibrary;
using spectral::unitRandom;

/// Layers all over table 3.2: every corner of melanin, blood and thickness at three wavelengths, then draws.
std::vector<LayerOptics> layersOfSkin(int draws) {
  const SkinModel model(testLibrary(), {380, 414, 580, 780});
  std::vector<LayerOptics> result;
  for (int corner = 0; corner < 8; ++corner) {
    const SkinParameters skin{(corner & 1) != 0 ? 1 : 0.001, (corner & 2) != 0 ? 1 : 0.001,
                              (corner & 4) != 0 ? 350.0 : 10.0, 0.5, 0.3};
    for (const LayerOptics& one : model.layers(skin)) {
      result.push_back(one);
    }
  }
  std::mt19937 random(7);
  while (static_cast<int>(result.size()) < 32 + draws) {
    SkinCoordinates at;
    for (Eigen::Index i = 0; i < 5; ++i) {
      at[i] = lowestCoordinates()[i] + (highestCoordinates()[i] - lowestCoordinates()[i]) * unitRandom(random);
    }
    const SkinModel single(testLibrary(), {380 + 400 * unitRandom(random)});
    result.push_back(single.layers(skinOf(at)).front());
  }
  return result;
}

TEST(LayeredAlbedo, IsWhatPlainDoublingGives) {
  // The fast solver's start is of high order, plain doubling's a thin layer of second order.
  MaxDifference difference("fast against plain doubling, same directions", 1e-5);
  for (const LayerOptics& layers : layersOfSkin(60)) {
    difference.add(layeredAlbedo(layers), layeredAlbedoByPlainDoubling(layers, kStreamsPerHemisphere));
  }
}

TEST(LayeredAlbedo, HasEnoughDirections) {
  MaxDifference difference("4 against 10 directions a hemisphere", 6e-4);
  for (const LayerOptics& layers : layersOfSkin(30)) {
    difference.add(layeredAlbedo(layers), layeredAlbedoByPlainDoubling(layers, 10));
  }
}

TEST(LayeredAlbedo, OfNoAbsorptionIsOne) {
  LayerOptics layers{0, 0, 100, 0.8, 0.01, std::numeric_limits<double>::infinity()};
  // An infinite dermis is one of 4096 mean free paths, and lets a little through.
  EXPECT_NEAR(layeredAlbedo(layers), 1, 2e-3);
  EXPECT_LE(layeredAlbedo(layers), 1);
}

TEST(LayeredAlbedo, OfAnIsotropicHalfSpaceIsChandrasekhars) {
  // Diffuse reflection of a semi-infinite isotropic medium by its H functions, 1 - 2 sqrt(1 - w) times H's first
  // moment: computed here from the integral equation of H.
  constexpr int kPoints = 2000;
  for (const double whole : {0.5, 0.9, 0.99}) {
    std::vector<double> h(kPoints, 1.0);
    const auto cosine = [](int i) { return (i + 0.5) / kPoints; };
    for (int round = 0; round < 200; ++round) {
      std::vector<double> next(h.size());
      for (int i = 0; i < kPoints; i += 1) {
        double sum = 0;
        for (int j = 0; j < kPoints; j += 10) {
          const int at = j + 5;
          sum += cosine(at) * h[static_cast<std::size_t>(at)] / (cosine(i) + cosine(at)) * 10 / kPoints;
        }
        next[static_cast<std::size_t>(i)] = 1 / (std::sqrt(1 - whole) + whole / 2 * sum);
      }
      h = next;
    }
    double moment = 0;
    for (int i = 0; i < kPoints; ++i) {
      moment += cosine(i) * h[static_cast<std::size_t>(i)] / kPoints;
    }
    const double expected = 1 - 2 * std::sqrt(1 - whole) * moment;
    const LayerOptics layers{
        (1 - whole) / whole, (1 - whole) / whole, 1, 0, 1, std::numeric_limits<double>::infinity()};
    EXPECT_NEAR(layeredAlbedo(layers), expected, 1e-3) << whole;
  }
}

TEST(LayeredAlbedo, OfTwoEqualLayersDoesNotSeeTheBorder) {
  const LayerOptics thin{3, 3, 150, 0.78, 0.001, 0.2};
  const LayerOptics thick{3, 3, 150, 0.78, 0.03, 0.171};
  EXPECT_NEAR(layeredAlbedo(thin), layeredAlbedo(thick), 1e-6);
}

TEST(LayeredAlbedo, OfAnyNumberAtOnceIsTheSame) {
  const std::vector<LayerOptics> layers = layersOfSkin(5);
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{3}, std::size_t{4}, std::size_t{37}}) {
    std::vector<double> albedos(count);
    layeredAlbedos({layers.data(), count}, albedos);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(albedos[i], layeredAlbedo(layers[i])) << i;
    }
  }
}

TEST(LayeredAlbedo, OfAGridIsThatOfEachPair) {
  // A shallow dermis and a deep one; the counts are no multiples of the lanes.
  for (const double dermisCm : {0.21, 0.6, std::numeric_limits<double>::infinity()}) {
    const LayerGrid grid{{0, 0.3, 4, 70, 2e5}, {0.02, 1, 9, 40, 200, 3e3, 1e5}, 230, 0.78, 0.012, dermisCm};
    std::vector<double> albedos(5 * 7);
    layeredAlbedoGrid(grid, albedos);
    for (std::size_t i = 0; i < albedos.size(); ++i) {
      EXPECT_EQ(albedos[i], layeredAlbedo({grid.epidermisAbsorptions[i / 7], grid.dermisAbsorptions[i % 7], 230, 0.78,
                                           0.012, dermisCm}))
          << i << ' ' << dermisCm;
    }
  }
}

}  // namespace
}  // namespace metamer::skin
