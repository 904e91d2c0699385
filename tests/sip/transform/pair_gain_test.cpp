// SPDX-License-Identifier: Apache-2.0
#include "transform/pair_gain.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "metamer/spectral/colorimetry.h"
#include "sip/transform/transform_fixture.h"
#include "transform/sides.h"

namespace metamer::sip {
namespace {

using Eigen::Vector3d;

/// An emitter 15 nm wide at half its height.
spectral::Spectrum emitter(double wavelengthNm) {
  std::vector<double> wavelengths;
  std::vector<double> power;
  for (int nm = 380; nm <= 780; ++nm) {
    wavelengths.push_back(nm);
    const double distance = (nm - wavelengthNm) / 6.4;
    power.push_back(std::exp(-0.5 * distance * distance));
  }
  return spectral::Spectrum("one LED", spectral::SpectralQuantity::SpectralPowerDistribution, wavelengths, power);
}

PairWeights weightsOf(const TransformSpec& spec) {
  const Sides sides = prepareSides(spec);
  return {sides.inputWeights(kDecisionBandCount), sides.relativeWeights(kDecisionBandCount),
          sides.relativeFromResponse};
}

Eigen::MatrixXd surfacesOf(const TransformSpec& spec) {
  return onBands(spec.training, kDecisionBandCount);
}

TransformSpec fromLight(const spectral::Spectrum& light) {
  TransformSpec spec = naturalSpecOf("D65", "D65");
  spec.input.illuminant = light;
  return spec;
}

TEST(PairGainTest, LightsThatTellChannelsApartAreMetExactly) {
  for (const auto& pair : lightPairs()) {
    const TransformSpec spec = naturalSpecOf(pair.first, pair.second);
    const double gain = gainOf(weightsOf(spec), surfacesOf(spec), 0.0);
    EXPECT_GT(gain, 0.5) << pairName(pair);
    EXPECT_LE(gain, kLargestGain) << pairName(pair);
    EXPECT_EQ(relaxationOf(weightsOf(spec), surfacesOf(spec)), 0.0) << pairName(pair);
    const SpectralTransform transform(spec, 41);
    EXPECT_EQ(transform.diagnostics().relaxation, 0.0) << pairName(pair);
    EXPECT_EQ(transform.diagnostics().gain, gain) << pairName(pair);
  }
}

TEST(PairGainTest, LightsThatDoNotAreRelaxed) {
  for (const spectral::Spectrum& light : {testLibrary().illuminant("LPS"), laser(532.0), laser(589.0), laser(633.0),
                                          emitter(450.0), emitter(530.0), emitter(620.0)}) {
    const TransformSpec spec = fromLight(light);
    const PairWeights pair = weightsOf(spec);
    const Eigen::MatrixXd surfaces = surfacesOf(spec);
    const double exact = gainOf(pair, surfaces, 0.0);
    const double relaxation = relaxationOf(pair, surfaces);
    const double relaxed = gainOf(pair, surfaces, relaxation);
    std::printf("[ pair ] %s: gain %.3g, relaxation %.3g brings it to %.3g\n", light.name().c_str(), exact, relaxation,
                relaxed);
    EXPECT_GT(exact, kLargestGain) << light.name();
    EXPECT_GT(relaxation, 0.0) << light.name();
    EXPECT_LE(relaxed, kLargestGain) << light.name();
    // As much as will do: a hundredth more is too much. A line alone asks for nothing that a spectrum gives.
    if (light.name() != "laser") {
      EXPECT_GT(gainOf(pair, surfaces, 1.01 * relaxation), 0.999 * kLargestGain) << light.name();
    }
    // The other way the light is as good as any.
    TransformSpec back = spec;
    std::swap(back.input, back.output);
    for (const TransformSpec& way : {spec, back}) {
      const SpectralTransform transform(way, 41);
      for (const Vector3d& colour : colours(300)) {
        const auto local = transform.linearise(colour);
        ASSERT_TRUE(local.value.allFinite() && local.matrix.allFinite()) << light.name() << ": " << colour.transpose();
      }
    }
  }
}

TEST(PairGainTest, GainIsTheFullFormulasOverNinetyFiveInAHundredSurfaces) {
  for (const auto& pair : {lightPairs()[0], lightPairs()[3]}) {
    TransformSpec spec = naturalSpecOf(pair.first, pair.second);
    spec.adaptation = 1.0;
    spec.scene.kind = ReferenceScene::Kind::Smooth;
    const SpectralTransform transform(spec, kDecisionBandCount);
    const Eigen::Matrix3d relative = RelativeColours(transform).relativeFromRgb();
    const Eigen::Matrix3d matrix = relative * transform.linearMatrix() * relative.inverse();
    const auto labOf = [](const Vector3d& ratio) { return spectral::lab(ratio, Vector3d::Ones()); };
    std::mt19937 random(13);
    std::vector<double> gains;
    for (const spectral::DomainSamples& surface : spec.training) {
      const Vector3d colour = relative * inputRgb(spec, transform, surface);
      double worst = 0.0;
      for (int i = 0; i < 200; ++i) {
        Vector3d direction{unitRandom(random), unitRandom(random), unitRandom(random)};
        direction = (2.0 * direction - Vector3d::Ones()).cwiseProduct(colour);
        const Vector3d moved = colour + 1e-4 * direction;
        worst = std::max(worst, spectral::deltaE2000(labOf(matrix * colour), labOf(matrix * moved)) /
                                    spectral::deltaE2000(labOf(colour), labOf(moved)));
      }
      gains.push_back(worst);
    }
    std::sort(gains.begin(), gains.end());
    const double expected = gains[gains.size() * 95 / 100];
    const double found = transform.diagnostics().gain;
    std::printf("[ pair ] %s: gain %.3f, of steps %.3f\n", pairName(pair).c_str(), found, expected);
    // The engine's limit for small steps leaves out the slope of CIEDE2000's stretch of a*.
    EXPECT_NEAR(found, expected, 0.1 * expected) << pairName(pair);
  }
}

TEST(PairGainTest, RelaxedTransformsAreTheSameAtAnyBandCount) {
  TransformSpec spec = naturalSpecOf("LPS", "D65");
  spec.adaptation = 1.0;
  const SpectralTransform converged(spec, kConvergedBandCount);
  const SpectralTransform coarse(spec, 81);
  EXPECT_EQ(coarse.diagnostics().relaxation, converged.diagnostics().relaxation);
  double largest = 0.0;
  for (const spectral::DomainSamples& surface : spec.training) {
    const Vector3d rgb = inputRgb(spec, converged, surface);
    largest = std::max(largest, (coarse.apply(rgb) - converged.apply(rgb)).norm() / rgb.norm());
  }
  std::printf("[ pair ] LPS -> D65: 81 bands within %.3g of 401\n", largest);
  EXPECT_LE(largest, 0.05);
}

}  // namespace
}  // namespace metamer::sip
