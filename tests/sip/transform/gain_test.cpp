// SPDX-License-Identifier: Apache-2.0
// How much a transform makes of small differences, on saturated lights and over the working gamut, and whether it
// folds.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "metamer/sip/spectral_locus.h"
#include "metamer/spectral/colorimetry.h"
#include "sip/transform/transform_fixture.h"

namespace metamer::sip {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

const std::vector<std::pair<std::string, std::string>>& judgedPairs() {
  static const std::vector<std::pair<std::string, std::string>> pairs{
      {"D65", "A"}, {"D65", "HP1"}, {"A", "D65"}, {"LED-RGB1", "D65"}};
  return pairs;
}

TransformSpec fullyAdapted(const std::pair<std::string, std::string>& pair) {
  TransformSpec spec = naturalSpecOf(pair.first, pair.second);
  spec.adaptation = 1.0;
  return spec;
}

/// CIEDE2000 out per CIEDE2000 in, worst of 26 directions, for a step of a thousandth of the colour and at most a
/// twentieth of its luminance.
double gainAt(const RelativeColours& relative, const Vector3d& colour) {
  const auto labOf = [](const Vector3d& ratio) { return spectral::lab(ratio, Vector3d::Ones()); };
  const double step = std::min(1e-3 * colour.cwiseAbs().maxCoeff(), 0.05 * std::abs(colour.y()));
  const Vector3d in = labOf(colour);
  const Vector3d out = labOf(relative.apply(colour));
  double worst = 0.0;
  for (int code = 0; code < 27; ++code) {
    const Vector3d direction(code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1);
    if (direction.isZero(0.0)) {
      continue;
    }
    const Vector3d moved = colour + step * direction.normalized();
    worst = std::max(worst,
                     spectral::deltaE2000(out, labOf(relative.apply(moved))) / spectral::deltaE2000(in, labOf(moved)));
  }
  return worst;
}

/// Emitters 15 and 25 nm wide and a gel lamp's colours, with white in them, next to the locus and on their way from it.
std::vector<Vector3d> saturatedLights() {
  const TransformSpec spec = naturalSpecOf("D65", "D65");
  const auto curves = spec.standardObserver.onDomain();
  const Eigen::Vector2d white = spectral::chromaticity(spec.space.whiteXyz());
  const SpectralLocus locus(spec.standardObserver);
  std::vector<Vector3d> lights;
  const auto add = [&](const Vector3d& xyz) {
    for (const double share : {0.0, 0.1, 0.3, 0.6}) {
      const Vector3d mixed = (1.0 - share) * xyz / xyz.y() + share * spec.space.whiteXyz();
      const Eigen::Vector2d way = spectral::chromaticity(mixed) - white;
      if (way.norm() < 0.985 * locus.distanceFrom(white, way.normalized())) {
        lights.emplace_back(0.18 * mixed.cwiseQuotient(spec.space.whiteXyz()));
      }
    }
  };
  for (int peak = 400; peak <= 700; peak += 20) {
    for (const double width : {15.0, 25.0}) {
      spectral::DomainSamples power;
      for (int i = 0; i < spectral::kDomainSize; ++i) {
        const double distance = (380.0 + i - peak) / (width / 2.3548);
        power[i] = std::exp(-0.5 * distance * distance);
      }
      add(curves.transpose() * power);
    }
  }
  const spectral::DomainSamples tungsten = testLibrary().illuminant("A").onDomain();
  for (const char* const gel : {"Lee 106 Primary Red", "Lee 119 Dark Blue", "Lee 139 Primary Green"}) {
    add(curves.transpose() * tungsten.cwiseProduct(testLibrary().filter(gel).onDomain()));
  }
  return lights;
}

/// The working gamut, evenly.
std::vector<Vector3d> gamutColours(const SpectralTransform& transform, int count) {
  std::mt19937 random(6);
  std::vector<Vector3d> made;
  const RelativeColours relative(transform);
  for (int i = 0; i < count; ++i) {
    Vector3d rgb{unitRandom(random), unitRandom(random), unitRandom(random)};
    const Vector3d colour = relative.relativeFromRgb() * (rgb / rgb.sum());
    if (colour.minCoeff() > 1e-3) {
      made.emplace_back(0.18 / colour.y() * colour);
    }
  }
  return made;
}

struct Gains {
  double p99 = 0.0;
  double worst = 0.0;
};

Gains gainsOver(const RelativeColours& relative, const std::vector<Vector3d>& places) {
  std::vector<double> gains;
  for (const Vector3d& colour : places) {
    gains.push_back(gainAt(relative, colour));
  }
  std::sort(gains.begin(), gains.end());
  return {gains[static_cast<std::size_t>(std::ceil(0.99 * static_cast<double>(gains.size()))) - 1], gains.back()};
}

TEST(TransformGainTest, SmallDifferencesStaySmall) {
  const std::vector<Vector3d> lights = saturatedLights();
  EXPECT_GT(lights.size(), 70U);
  Gains lightMean;
  Gains gamutMean;
  for (const auto& pair : judgedPairs()) {
    const SpectralTransform transform(fullyAdapted(pair), 41);
    const RelativeColours relative(transform);
    const Gains onLights = gainsOver(relative, lights);
    const Gains overGamut = gainsOver(relative, gamutColours(transform, 300));
    std::printf("[ gain ] %s: saturated lights p99 %.2f, worst %.2f; gamut p99 %.2f, worst %.2f\n",
                pairName(pair).c_str(), onLights.p99, onLights.worst, overGamut.p99, overGamut.worst);
    EXPECT_LE(onLights.worst, 10.0) << pairName(pair);
    EXPECT_LE(overGamut.worst, 8.0) << pairName(pair);
    lightMean.p99 += onLights.p99 / static_cast<double>(judgedPairs().size());
    gamutMean.p99 += overGamut.p99 / static_cast<double>(judgedPairs().size());
  }
  EXPECT_LE(lightMean.p99, 4.0);
  EXPECT_LE(gamutMean.p99, 3.0);
}

/// Whether the map from chromaticity to chromaticity turns a small triangle over.
bool foldsAt(const RelativeColours& relative, const Eigen::Vector2d& place, const Vector3d& white) {
  const auto colourOf = [&](const Eigen::Vector2d& xy) -> Vector3d {
    return spectral::xyzFromChromaticity(xy, 0.18).cwiseQuotient(white);
  };
  const auto resultOf = [&](const Eigen::Vector2d& xy) -> Eigen::Vector2d {
    return spectral::chromaticity(relative.apply(colourOf(xy)).cwiseProduct(white));
  };
  constexpr double kStep = 1e-5;
  const Eigen::Vector2d middle = resultOf(place);
  Eigen::Matrix2d slope;
  slope.col(0) = resultOf(place + Eigen::Vector2d(kStep, 0.0)) - middle;
  slope.col(1) = resultOf(place + Eigen::Vector2d(0.0, kStep)) - middle;
  return slope.determinant() < 0.0;
}

TEST(TransformGainTest, ChromaticitiesDoNotFold) {
  for (const auto& pair : judgedPairs()) {
    const TransformSpec spec = fullyAdapted(pair);
    const SpectralTransform transform(spec, 41);
    const RelativeColours relative(transform);
    const SpectralLocus locus(spec.standardObserver);
    const spectral::RgbSpace& space = spec.space;
    int count = 0;
    int folded = 0;
    for (double x = 0.005; x < 0.75; x += 0.01) {
      for (double y = 0.005; y < 0.85; y += 0.01) {
        const Eigen::Vector2d place(x, y);
        const Vector3d rgb = space.rgbFromXyz() * spectral::xyzFromChromaticity(place, 0.18);
        if (rgb.minCoeff() > 0.0 && locus.contains(place)) {
          ++count;
          folded += foldsAt(relative, place, transform.whiteXyz()) ? 1 : 0;
        }
      }
    }
    std::printf("[ folds ] %s: %d of %d\n", pairName(pair).c_str(), folded, count);
    EXPECT_GT(count, 2000);
    EXPECT_LE(folded, count / 2000) << pairName(pair);  // 0.05 %
  }
}

}  // namespace
}  // namespace metamer::sip
