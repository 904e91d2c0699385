// SPDX-License-Identifier: Apache-2.0
#include "scenes/dataset_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "sip/transform/transform_fixture.h"

namespace metamer::sip {
namespace {

using Eigen::Vector3d;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kBands = 81;

/// The chart's colours, far apart in chromaticity: its neutrals are so near to white that steps between them are steep.
std::vector<spectral::DomainSamples> chromaticPatches() {
  const auto all = samplesOf("colorchecker");
  return {all.begin(), all.begin() + 18};
}

DatasetScene chartScene(const char* light) {
  return {SoftBoundSolver(normalisedWeights(light, kBands)), onBands(chromaticPatches(), kBands)};
}

TEST(DatasetSceneTest, GivesItsOwnPatchesExactly) {
  for (const auto& pair : lightPairs()) {
    TransformSpec spec = specOf(pair.first, pair.second);
    spec.scene.kind = ReferenceScene::Kind::Dataset;
    spec.scene.samples = samplesOf("colorchecker");  // also its greys, which are nearly one colour
    const SpectralTransform transform(spec, kConvergedBandCount);
    spectral::MaxDifference difference(pairName(pair) + ": patches of the dataset", 1e-9);
    int met = 0;
    for (const spectral::DomainSamples& patch : spec.scene.samples) {
      const Vector3d rgb = inputRgb(spec, transform, patch);
      if (transform.linearise(rgb).isLimited) {
        continue;
      }
      ++met;
      // At any exposure of it: the interpolation is over chromaticity.
      difference.add(transform.apply(0.5 * rgb), 0.5 * outputRgb(spec, patch));
    }
    EXPECT_GE(met, 20) << pairName(pair);
    for (const Vector3d& colour : colours(200)) {
      ASSERT_TRUE(transform.apply(colour).allFinite()) << pairName(pair);
    }
    EXPECT_TRUE(transform.linearConeCorners().empty());
  }
}

TEST(DatasetSceneTest, ContinuousAcrossItsHullAndToItsEnd) {
  const DatasetScene scene = chartScene("D65");
  double largest = 0.0;
  // From white outwards in the plane of sum 1, and to where the sum vanishes.
  for (int ray = 0; ray < 6; ++ray) {
    const double angle = ray * 1.0472;
    const Vector3d direction(std::cos(angle), std::sin(angle), -std::cos(angle) - std::sin(angle));
    BandVector before = scene.deviation(Vector3d::Constant(1.0 / 3.0));
    constexpr double kStep = 1e-5;
    for (int i = 1; i < 40000; ++i) {
      const BandVector deviation = scene.deviation(Vector3d::Constant(1.0 / 3.0) + i * kStep * direction);
      largest = std::max(largest, (deviation - before).norm() / kStep);
      before = deviation;
    }
    for (const double sum : {1e-3, 1e-6, 1e-12}) {
      EXPECT_LE(scene.deviation(direction + Vector3d::Constant(sum / 3.0)).norm(), 10.0 * sum) << angle;
    }
    EXPECT_TRUE(scene.deviation(direction - Vector3d::Constant(1e-9)).isZero(0.0));
  }
  std::printf("[ dataset ] deviation changes by at most %.3g a step of 1 in chromaticity\n", largest);
  // A jump of 0.01 within a step would be 1000; two samples at the least distance apart are a slope of hundreds.
  EXPECT_LE(largest, 500.0);
}

TEST(DatasetSceneTest, DerivativeAgainstDifferences) {
  const DatasetScene scene = chartScene("FL11");
  int unlike = 0;
  const auto all = colours(300);
  for (const Vector3d& colour : all) {
    const DatasetScene::Local local = scene.local(colour);
    EXPECT_LE((local.value - scene.deviation(colour)).norm(), 1e-13);
    EXPECT_LE((local.slope * colour - local.value).norm(), 1e-12);
    const Vector3d step = 1e-7 * Vector3d(1, -2, 3);
    const BandVector change = scene.deviation(colour + step) - scene.deviation(colour - step);
    // A kink is seldom this near.
    unlike += (change - 2.0 * local.slope * step).norm() > 1e-6 * change.norm() + 1e-13 ? 1 : 0;
  }
  EXPECT_LE(unlike, static_cast<int>(all.size()) / 50);
}

TEST(DatasetSceneTest, OddColoursHaveNoDeviation) {
  const DatasetScene scene = chartScene("D65");
  for (const Vector3d& colour :
       {Vector3d(kNan, 1, 1), Vector3d(-kInfinity, 1, 1), Vector3d(0, 0, 0), Vector3d(1, -2, 0.5)}) {
    EXPECT_TRUE(scene.deviation(colour).isZero(0.0)) << colour.transpose();
    EXPECT_TRUE(scene.local(colour).slope.isZero(0.0)) << colour.transpose();
  }
}

TEST(DatasetSceneTest, ScenesNeedSamplesThatSpanAPlane) {
  TransformSpec spec = specOf("D65", "A");
  for (const auto kind : {ReferenceScene::Kind::Natural, ReferenceScene::Kind::Skin, ReferenceScene::Kind::Dataset}) {
    spec.scene = {.kind = kind, .samples = {}, .skins = {}, .strength = 1.0};
    EXPECT_NE(errorOf([&] { SpectralTransform transform(spec); }).find("scene.set"), std::string::npos);
  }
  spec.scene.kind = ReferenceScene::Kind::Skin;
  spec.scene.samples = samplesOf("skin");
  for (const double strength : {kNan, -0.1, 1.1}) {
    spec.scene.strength = strength;
    EXPECT_NE(errorOf([&] { SpectralTransform transform(spec); }).find("scene.strength"), std::string::npos);
  }
  spec.scene = {.kind = ReferenceScene::Kind::Dataset, .samples = samplesOf("skin"), .skins = {}, .strength = 1.0};
  spec.scene.samples.resize(1);
  EXPECT_NE(errorOf([&] { SpectralTransform transform(spec); }).find("do not span a plane"), std::string::npos);
}

}  // namespace
}  // namespace metamer::sip
