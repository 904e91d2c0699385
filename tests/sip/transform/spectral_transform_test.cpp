// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/spectral_transform.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <cstdio>
#include <random>

#include "metamer/sip/error_protocol.h"
#include "sip/transform/transform_fixture.h"

namespace metamer::sip {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

TEST(SpectralTransformTest, IdentityCopiesExactly) {
  TransformSpec spec = specOf("HP1", "HP1");
  spec.adaptation = 0.7;  // both sides have the same white: nothing to adapt to
  const SpectralTransform transform(spec);
  EXPECT_TRUE(transform.isIdentity());
  EXPECT_EQ(transform.linearMatrix(), Matrix3d(Matrix3d::Identity()));
  std::vector<float> pixels{0.1F, -0.2F, 65504.0F, 0.5F, 1e-42F, 3e38F, -0.0F, 1.0F};
  const std::vector<float> before = pixels;
  transform.apply(pixels);
  EXPECT_EQ(pixels, before);
  for (const Vector3d& colour : colours(100)) {
    EXPECT_EQ(transform.apply(colour), colour);
    EXPECT_EQ(transform.linearise(colour).value, colour);
  }
  EXPECT_FALSE(SpectralTransform(specOf("D65", "HP1")).isIdentity());
}

TEST(SpectralTransformTest, OneThatIsAssignedIsTheOther) {
  SpectralTransform transform(specOf("HP1", "HP1"));
  transform = SpectralTransform(specOf("D65", "A"));
  EXPECT_FALSE(transform.isIdentity());
  const Vector3d colour(0.4, 0.2, 0.1);
  EXPECT_EQ(transform.apply(colour), SpectralTransform(specOf("D65", "A")).apply(colour));
}

TEST(SpectralTransformTest, KeptExposureOfTheSameFilterOnBothSidesIsIdentity) {
  TransformSpec spec = specOf("D65", "D65");
  const spectral::Spectrum gel = testLibrary().filter("ISO Standard Lens");
  spec.input.filters = {{gel, 1.0}};
  spec.output.filters = {{gel, 1.0}};
  spec.keepExposure = true;
  EXPECT_TRUE(SpectralTransform(spec).isIdentity());
}

TEST(SpectralTransformTest, WhiteGoesWhereAdaptationSays) {
  for (const auto& pair : lightPairs()) {
    spectral::MaxDifference kept(pairName(pair) + ": neutrals at D = 1", 1e-9);
    spectral::MaxDifference cast(pairName(pair) + ": white at any D", 1e-9);
    for (const auto cat : {spectral::ChromaticAdaptation::VonKries, spectral::ChromaticAdaptation::Bradford,
                           spectral::ChromaticAdaptation::Cat02, spectral::ChromaticAdaptation::Cat16}) {
      TransformSpec spec = specOf(pair.first, pair.second);
      spec.cat = cat;
      for (const double adaptation : {0.0, 0.25, 0.5, 1.0}) {
        spec.adaptation = adaptation;
        const SpectralTransform transform(spec);
        cast.add(transform.apply(Vector3d::Ones()), outputRgb(spec, spectral::DomainSamples::Ones()));
        if (adaptation == 1.0) {
          for (const double grey : {0.18, 1.0, 20.0}) {
            kept.add(transform.apply(Vector3d::Constant(grey)) / grey, Vector3d::Ones());
          }
        }
      }
      // D = 0: what an eye that stays with the input light sees of the new light.
      spec.adaptation = 0.0;
      const PreparedPipeline input = prepare(spec.input, {}, spec.standardObserver);
      const PreparedPipeline output = prepare(spec.output, {}, spec.standardObserver);
      const Vector3d seen = spec.space.rgbFromXyz() * spectral::adaptXyz(cat, input.whiteXyz(), spec.space.whiteXyz()) *
                            output.whiteXyz();
      cast.add(SpectralTransform(spec).apply(Vector3d::Ones()), seen);
    }
  }
}

TEST(SpectralTransformTest, WholeStopsAreExactAndOthersNearlySo) {
  for (const auto& pair : {lightPairs()[1], lightPairs()[5]}) {
    const SpectralTransform transform(specOf(pair.first, pair.second));
    spectral::MaxDifference difference(pairName(pair) + ": exposures of -20 to +20 stops", 1e-6);
    std::mt19937 random(5);
    for (const Vector3d& colour : colours(300)) {
      const Vector3d result = transform.apply(colour);
      for (const int stop : {-20, -7, -1, 1, 3, 20}) {
        ASSERT_EQ(transform.apply(std::ldexp(1.0, stop) * colour), Vector3d(std::ldexp(1.0, stop) * result))
            << pairName(pair) << ": " << colour.transpose();
      }
      const double exposure = std::exp2(40.0 * unitRandom(random) - 20.0);
      difference.add(transform.apply(exposure * colour) / (exposure * result.norm()), result / result.norm());
    }
  }
}

TEST(SpectralTransformTest, DefaultBandsAgainstConverged) {
  for (const auto& pair : lightPairs()) {
    const TransformSpec spec = specOf(pair.first, pair.second);
    const ErrorProtocol protocol(spec, chart());
    const SpectralTransform transform(spec);
    const ErrorProtocol::Report report = protocol.measure([&](std::span<float> rgba) { transform.apply(rgba); });
    std::printf("[ bands ] %s, %d bands: mean %.4f p99 %.4f max %.4f of %zu probes; worst %s\n", pairName(pair).c_str(),
                transform.bandCount(), report.mean, report.p99, report.max, report.count, report.worstProbe.c_str());
    EXPECT_LE(report.p99, 0.1) << pairName(pair);
    EXPECT_LE(report.max, 0.5) << pairName(pair);
    EXPECT_GE(report.count, 21U * 1024);
  }
}

TEST(SpectralTransformTest, BorderDoesNotDependOnTheBands) {
  // A line of emission at the end of the observer's range that is in at one number of bands and out at another moves
  // all colours beyond the border: daylight's probes, many of which no reflectance makes under these lights.
  const ErrorProtocol daylight(specOf("D65", "A"), chart());
  for (const char* const light : {"Mercury", "HP1"}) {
    const TransformSpec spec = specOf(light, "D65");
    const SpectralTransform transform(spec);
    const SpectralTransform converged(spec, kConvergedBandCount);
    const ErrorProtocol::Report report =
        daylight.measureAgainst(converged, [&](std::span<float> rgba) { transform.apply(rgba); });
    std::printf("[ bands ] %s -> D65: p99 %.4f max %.4f; worst %s\n", light, report.p99, report.max,
                report.worstProbe.c_str());
    EXPECT_LE(report.p99, 0.2) << light;
  }
}

TEST(SpectralTransformTest, InvertsItsOwnSpectrum) {
  for (const TransformSpec& spec : {specOf("D65", "HP1"), naturalSpecOf("D65", "HP1")}) {
    const SpectralTransform transform(spec, kConvergedBandCount);
    ASSERT_EQ(transform.diagnostics().relaxation, 0.0);
    spectral::MaxDifference in("input response of the reflectance", 1e-9);
    spectral::MaxDifference out("output of the reflectance, where nothing is limited", 1e-9);
    int whole = 0;
    for (const Vector3d& colour : colours(300)) {
      const spectral::DomainSamples reflectance = transform.reflectance(colour);
      in.add(inputRgb(spec, transform, reflectance), colour);
      const auto local = transform.linearise(colour);
      EXPECT_EQ(local.clamped.any(), reflectance.minCoeff() < -1e-12 * reflectance.maxCoeff());
      if (!local.isLimited) {
        ++whole;
        out.add(transform.apply(colour), outputRgb(spec, reflectance));
      }
    }
    EXPECT_GT(whole, 50);
    EXPECT_LT(whole, 300);
  }
}

TEST(SpectralTransformTest, LinearisationIsTheDerivative) {
  for (const TransformSpec& spec : {specOf("D65", "FL11"), naturalSpecOf("D65", "FL11"), naturalSpecOf("LPS", "D65")}) {
    const SpectralTransform transform(spec, 81);
    spectral::MaxDifference value("linearised value", 1e-12);
    int unlike = 0;
    const auto all = colours(300);
    for (const Vector3d& colour : all) {
      const auto local = transform.linearise(colour);
      const double size = local.value.norm();
      value.add(local.value / size, transform.apply(colour) / size);
      value.add(local.matrix * colour / size, local.value / size);  // homogeneity
      const Vector3d step = 1e-6 * Vector3d(1, -2, 3);
      const Vector3d change = transform.apply(colour + step) - transform.apply(colour - step);
      // A kink between the two points is where they may differ; few are that close to one.
      unlike += (change - 2.0 * local.matrix * step).norm() > 1e-6 * change.norm() + 1e-12 ? 1 : 0;
    }
    EXPECT_LE(unlike, static_cast<int>(all.size()) / 50);
  }
}

TEST(SpectralTransformTest, LinearConeIsTheLinearMatrix) {
  for (const auto& pair : lightPairs()) {
    const SpectralTransform transform(specOf(pair.first, pair.second));
    const std::vector<Vector3d> corners = transform.linearConeCorners();
    ASSERT_GE(corners.size(), 3U) << pairName(pair);
    spectral::MaxDifference difference(pairName(pair) + ": matrix inside the linear cone", 1e-12);
    std::mt19937 random(9);
    Vector3d middle = Vector3d::Zero();
    for (const Vector3d& corner : corners) {
      middle += corner.normalized();
    }
    for (int i = 0; i < 200; ++i) {
      Vector3d mixture = 1e-6 * middle;
      for (const Vector3d& corner : corners) {
        mixture += unitRandom(random) / corner.norm() * corner;
      }
      const auto local = transform.linearise(mixture);
      EXPECT_TRUE(local.clamped.none() && !local.isLimited) << pairName(pair) << ": " << mixture.transpose();
      difference.add(transform.linearMatrix() * mixture / local.value.norm(),
                     transform.apply(mixture) / local.value.norm());
    }
    // And the cone is all of it: a step across a side leaves it.
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vector3d side = corners[i].normalized() + corners[(i + 1) % corners.size()].normalized();
      const auto outside = transform.linearise(side + 1e-3 * (side - middle / middle.norm() * side.norm()));
      EXPECT_TRUE(outside.clamped.any() || outside.isLimited) << pairName(pair) << ": " << side.transpose();
    }
  }
}

TEST(SpectralTransformTest, AnyBandCount) {
  const TransformSpec spec = specOf("D65", "HP1");
  for (const int bands : {kMinimumBandCount, 41, 81, 128, kConvergedBandCount}) {
    const SpectralTransform transform(spec, bands);
    EXPECT_EQ(transform.bandCount(), bands);
    for (const Vector3d& colour : colours(100)) {
      ASSERT_TRUE(transform.apply(colour).allFinite()) << bands << ": " << colour.transpose();
    }
    EXPECT_LE((transform.apply(Vector3d::Ones()) - outputRgb(spec, spectral::DomainSamples::Ones())).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace metamer::sip
