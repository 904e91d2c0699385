// SPDX-License-Identifier: Apache-2.0
// What the engine promises of every colour: energy, steepness, no folds.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "metamer/spectral/colorimetry.h"
#include "metamer/spectral/spectral_files.h"
#include "sip/transform/transform_fixture.h"

namespace metamer::sip {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Luminance out over in of random colours, least and most, against a transform's own reach.
struct Energy {
  double least = 1.0;
  double most = 1.0;
  int count = 0;
};

void addEnergy(const TransformSpec& spec, int bandCount, int colourCount, unsigned seed, Energy& energy) {
  const SpectralTransform transform(spec, bandCount);
  const auto reach = transform.diagnostics();
  const RelativeColours relative(transform);
  const std::string name = spec.input.illuminant.name() + " -> " + spec.output.illuminant.name();
  // Where reaches are raised, they are raised this far at the most.
  EXPECT_LE(reach.reachUp, 3.5) << name;
  EXPECT_LE(reach.reachDown, 0.95) << name;
  EXPECT_LE(reach.reachAside, 12.0) << name;
  std::mt19937 random(seed);
  for (int i = 0; i < colourCount; ++i) {
    Vector3d colour{unitRandom(random), unitRandom(random), unitRandom(random)};
    colour = i % 3 == 0 ? colour : Vector3d(2.0 * colour - Vector3d::Ones());
    const Vector3d result = relative.apply(colour);
    ASSERT_TRUE(result.allFinite()) << name << ": " << colour.transpose();
    ++energy.count;
    if (colour.y() > 1e-6 * colour.norm()) {
      const double ratio = result.y() / colour.y();
      ASSERT_LE(ratio, (1.0 + reach.reachUp) * (1.0 + 1e-9)) << name << ": " << colour.transpose();
      ASSERT_GE(ratio, (1.0 - reach.reachDown) * (1.0 - 1e-9)) << name << ": " << colour.transpose();
      energy.most = std::max(energy.most, ratio);
      energy.least = std::min(energy.least, ratio);
    } else if (colour.y() < 0.0) {
      ASSERT_NEAR(result.y(), colour.y(), 1e-9 * colour.norm()) << name;
    }
  }
}

TransformSpec withAdaptation(TransformSpec spec) {
  spec.adaptation = 1.0;
  return spec;
}

TEST(TransformBoundsTest, LuminanceStaysWithinReachForEveryLamp) {
  const auto names = testLibrary().illuminantNames();
  TransformSpec spec = withAdaptation(naturalSpecOf("D65", "D65"));
  const spectral::Spectrum daylight = spec.input.illuminant;
  Energy energy;
  int refused = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (const bool fromDaylight : {true, false}) {
      spec.input.illuminant = fromDaylight ? daylight : testLibrary().illuminant(names[i]);
      spec.output.illuminant = fromDaylight ? testLibrary().illuminant(names[i]) : daylight;
      // The measured scene for one in ten: it takes its time to make.
      spec.scene.kind =
          (2 * i + (fromDaylight ? 1 : 0)) % 10 == 0 ? ReferenceScene::Kind::Natural : ReferenceScene::Kind::Smooth;
      try {
        addEnergy(spec, 41, 100, static_cast<unsigned>(i), energy);
      } catch (const spectral::InputError&) {
        ++refused;  // a cone that the light leaves dark
      }
    }
  }
  std::printf("[ energy ] %d colours, %zu lamps to and from D65 (%d refused): %.4f ... %.4f\n", energy.count,
              names.size(), refused, energy.least, energy.most);
  EXPECT_GE(energy.count, 20'000);
  EXPECT_LE(refused, 4);
}

TEST(TransformBoundsTest, LuminanceStaysWithinReachForLampsWithGaps) {
  std::vector<spectral::Spectrum> lamps = {
      spectral::readSpectralFile(std::filesystem::path(METAMER_TEST_DATA) / "lamps" / "cfl_with_zeros.csv",
                                 spectral::SpectralQuantity::SpectralPowerDistribution)
          .front()};
  // Smooth lamps of which 30 to 80 % of the bands are cut to zero, in stretches.
  std::mt19937 random(8);
  for (int i = 0; i < 6; ++i) {
    std::vector<double> wavelengths;
    std::vector<double> power;
    const double share = 0.3 + 0.1 * i;
    bool isDark = false;
    for (int nm = 380; nm <= 780; nm += 5) {
      if (nm % 20 == 0) {
        isDark = unitRandom(random) < share;
      }
      wavelengths.push_back(nm);
      power.push_back(isDark ? 0.0 : 0.5 + unitRandom(random));
    }
    lamps.emplace_back("gaps", spectral::SpectralQuantity::SpectralPowerDistribution, wavelengths, power);
  }
  Energy energy;
  for (const auto& lamp : lamps) {
    for (const char* const other : {"D65", "LED-RGB1"}) {
      TransformSpec spec = withAdaptation(naturalSpecOf(other, other));
      spec.input.illuminant = lamp;
      addEnergy(spec, 41, 300, 5, energy);
      std::swap(spec.input, spec.output);
      addEnergy(spec, 41, 300, 6, energy);
    }
  }
  std::printf("[ energy ] %d colours, %zu lamps with gaps: %.4f ... %.4f\n", energy.count, lamps.size(), energy.least,
              energy.most);
}

TEST(TransformBoundsTest, HomogeneousOverSixtyDecades) {
  for (const auto& pair : {lightPairs()[1], lightPairs()[3]}) {
    const SpectralTransform transform(naturalSpecOf(pair.first, pair.second), 81);
    for (const Vector3d& colour : colours(150)) {
      const Vector3d expected = transform.apply(colour);
      for (const double exposure : {1e-30, 1e-10, 0.7, 1e10, 1e30}) {
        const Vector3d scaled = transform.apply(Vector3d(exposure * colour)) / exposure;
        EXPECT_LE((scaled - expected).norm(), 1e-9 * expected.norm()) << pairName(pair) << ": " << colour.transpose();
      }
    }
  }
}

TEST(TransformBoundsTest, EqualPipelinesWithTheMeasuredSceneAreTheIdentity) {
  const SpectralTransform transform(naturalSpecOf("FL11", "FL11"), 81);
  EXPECT_TRUE(transform.isIdentity());
  for (const Vector3d& colour : colours(100)) {
    EXPECT_EQ(transform.apply(colour), colour);
  }
}

TEST(TransformBoundsTest, SteepnessOnTheWholeSphere) {
  for (const auto& pair :
       std::vector<std::pair<std::string, std::string>>{{"D65", "A"}, {"A", "D65"}, {"D65", "LED-RGB1"}}) {
    for (const auto kind : {ReferenceScene::Kind::Smooth, ReferenceScene::Kind::Natural}) {
      TransformSpec spec = withAdaptation(naturalSpecOf(pair.first, pair.second));
      spec.scene.kind = kind;
      const SpectralTransform transform(spec, 41);
      ASSERT_EQ(transform.diagnostics().reachUp, 3.0) << pairName(pair);
      ASSERT_EQ(transform.diagnostics().reachDown, 0.8) << pairName(pair);
      ASSERT_EQ(transform.diagnostics().reachAside, 4.0) << pairName(pair);
      const RelativeColours relative(transform);
      std::mt19937 random(4);
      const auto any = [&random]() -> Vector3d {
        Vector3d point{unitRandom(random), unitRandom(random), unitRandom(random)};
        return 2.0 * point - Vector3d::Ones();
      };
      struct Place {
        double steepness;
        Vector3d colour;
      };
      std::vector<Place> places;
      for (int i = 0; i < 4000; ++i) {
        const Vector3d colour = any().normalized();
        places.push_back({relative.steepness(colour), colour});
      }
      std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.steepness > b.steepness; });
      double largest = places.front().steepness;
      // Uphill from the steepest, in shrinking steps.
      for (std::size_t i = 0; i < 12; ++i) {
        Place place = places[i];
        for (double step = 0.05; step > 1e-4; step *= 0.85) {
          for (int attempt = 0; attempt < 4; ++attempt) {
            const Vector3d colour = (place.colour + step * any()).normalized();
            const double steepness = relative.steepness(colour);
            if (steepness > place.steepness) {
              place = {steepness, colour};
            }
          }
        }
        largest = std::max(largest, place.steepness);
      }
      std::printf("[ steepness ] %s, %s: %.3f\n", pairName(pair).c_str(), nameOf(kind).c_str(), largest);
      EXPECT_LE(largest, 6.0) << pairName(pair);
    }
  }
}

}  // namespace
}  // namespace metamer::sip
