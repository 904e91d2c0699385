// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdio>
#include <limits>

#include "metamer/sip/feasible_cone.h"
#include "sip/transform/transform_fixture.h"

namespace metamer::sip {
namespace {

using Eigen::Vector3d;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A patch's own spectrum on both sides, against the transform.
double largestPatchError(const TransformSpec& spec, const std::string& set) {
  const SpectralTransform transform(spec, kConvergedBandCount);
  double largest = 0.0;
  for (const spectral::DomainSamples& patch : samplesOf(set)) {
    const Vector3d expected = outputRgb(spec, patch);
    largest =
        std::max(largest, (transform.apply(inputRgb(spec, transform, patch)) - expected).norm() / expected.norm());
  }
  return largest;
}

TEST(SpectralTransformTest, ADatasetGivesItsOwnPatchesExactly) {
  for (const auto& pair : lightPairs()) {
    TransformSpec spec = specOf(pair.first, pair.second);
    spec.scene.kind = ReferenceScene::Kind::Dataset;
    // Patches far apart in chromaticity: near ones are averaged. The chart's neutrals are left out, because a neutral
    // is the perfect reflector.
    const auto all = samplesOf("colorchecker");
    spec.scene.samples.assign(all.begin(), all.begin() + 18);
    const SpectralTransform transform(spec, kConvergedBandCount);
    const double margin = 3e-3;  // the hull is drawn in by a thousandth of the way to white
    double onHull = 0.0;
    double inside = 0.0;
    int insideCount = 0;
    for (const spectral::DomainSamples& patch : spec.scene.samples) {
      const Vector3d rgb = inputRgb(spec, transform, patch);
      const Vector3d expected = outputRgb(spec, patch);
      const double error = (transform.apply(rgb) - expected).norm() / expected.norm();
      if (transform.isFeasible(rgb)) {
        inside = std::max(inside, error);
        ++insideCount;
      } else {
        onHull = std::max(onHull, error);
      }
    }
    std::printf("[ dataset ] %s: %d patches inside within %.2g, those on the hull within %.2g\n",
                pairName(pair).c_str(), insideCount, inside, onHull);
    EXPECT_LE(inside, 1e-9) << pairName(pair);
    EXPECT_GE(insideCount, 6) << pairName(pair);
    EXPECT_LE(onHull, margin) << pairName(pair);
    for (const Vector3d& colour : colours(200)) {
      ASSERT_TRUE(transform.apply(colour).allFinite()) << pairName(pair);
    }
    EXPECT_TRUE(transform.linearConeCorners().empty());
  }
}

TEST(SpectralTransformTest, PriorRunsFromSmoothToTheChart) {
  const auto& pair = lightPairs()[1];
  TransformSpec spec = specOf(pair.first, pair.second);
  const SpectralTransform smooth(spec, 81);
  const double smoothError = largestPatchError(spec, "colorchecker");
  spec.scene = {ReferenceScene::Kind::Prior, samplesOf("colorchecker"), 0.0, 0.04};
  const SpectralTransform none(spec, 81);
  spectral::MaxDifference difference("prior of strength 0 and smooth", 1e-9);
  for (const Vector3d& colour : colours(200)) {
    const Vector3d expected = smooth.apply(colour);
    difference.add(none.apply(colour) / expected.norm(), expected / expected.norm());
  }
  double before = smoothError;
  for (const double strength : {0.5, 1.0}) {
    spec.scene.strength = strength;
    spec.scene.radius = 0.005;  // so narrow that each patch is alone
    const double error = largestPatchError(spec, "colorchecker");
    std::printf("[ prior ] %s, strength %.1f: chart patches within %.4f, smooth %.4f\n", pairName(pair).c_str(),
                strength, error, smoothError);
    EXPECT_LT(error, before);
    before = error;
  }
  EXPECT_LT(before, 0.05);
  // Continuous and homogeneous with the blend too.
  const SpectralTransform prior(spec, 81);
  for (const Vector3d& colour : colours(100)) {
    const Vector3d result = prior.apply(colour);
    ASSERT_TRUE(result.allFinite());
    EXPECT_EQ(prior.apply(1024.0 * colour), Vector3d(1024.0 * result));
    EXPECT_LE((prior.apply(colour + 1e-9 * Vector3d(1, -1, 1)) - result).norm(), 1e-6) << colour.transpose();
  }
  EXPECT_TRUE(prior.linearConeCorners().empty());
}

TEST(SpectralTransformTest, ScenesNeedSamplesAndThreeChannels) {
  TransformSpec spec = specOf("D65", "A");
  spec.scene.kind = ReferenceScene::Kind::Prior;
  EXPECT_NE(errorOf([&] { SpectralTransform transform(spec); }).find("scene.set"), std::string::npos);
  spec.scene.samples = samplesOf("skin");
  spec.scene.strength = kNan;
  EXPECT_NE(errorOf([&] { SpectralTransform transform(spec); }).find("strength"), std::string::npos);
  spec.scene.strength = 1.0;
  spec.scene.radius = 0.0;
  EXPECT_NE(errorOf([&] { SpectralTransform transform(spec); }).find("radius"), std::string::npos);
  spec = specOf("LPS", "D65");
  spec.scene = {ReferenceScene::Kind::Dataset, samplesOf("skin"), 1.0, 0.04};
  EXPECT_NE(errorOf([&] { SpectralTransform transform(spec); }).find("use scene kind smooth"), std::string::npos);
}

}  // namespace
}  // namespace metamer::sip
