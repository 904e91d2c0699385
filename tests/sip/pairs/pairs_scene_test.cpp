// SPDX-License-Identifier: Apache-2.0
// A scene of pairs, from end to end: what DESIGN promises of colours whose spectra are known.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include "metamer/sip/band_weights.h"
#include "metamer/sip/homogeneous_map.h"
#include "metamer/sip/pairs.h"
#include "metamer/spectral/colorimetry.h"
#include "sip/transform/transform_fixture.h"

namespace metamer::sip {
namespace {

using Eigen::Vector3d;
using Kind = ReferenceScene::Kind;
using Samples = std::vector<spectral::DomainSamples>;

TransformSpec withPairs(const std::string& in, const std::string& out, Kind over, Samples pairs) {
  TransformSpec spec = naturalSpecOf(in, out);
  spec.scene.kind = Kind::Pairs;
  spec.scene.over = over;
  spec.scene.radius = over == Kind::Smooth ? kSmoothPairRadius : kDefaultPairRadius;
  spec.scene.pairs = std::move(pairs);
  return spec;
}

TransformSpec below(TransformSpec spec) {
  spec.scene.kind = spec.scene.over;
  return spec;
}

double difference(const SpectralTransform& transform, const Vector3d& a, const Vector3d& b) {
  const Eigen::Matrix3d xyzFromRgb = transform.space().xyzFromRgb();
  return spectral::deltaE2000(spectral::lab(xyzFromRgb * a, transform.whiteXyz()),
                              spectral::lab(xyzFromRgb * b, transform.whiteXyz()));
}

/// Reflectances that are 0.9 in a stretch of wavelengths and 0.03 beside it: nothing that a guess would come upon.
Samples blocks() {
  Samples samples;
  for (const auto& [from, to] : {std::pair(30, 120), std::pair(110, 190), std::pair(180, 215), std::pair(200, 320)}) {
    samples.emplace_back(spectral::DomainSamples::Constant(0.03));
    samples.back().segment(from, to - from).setConstant(0.9);
  }
  return samples;
}

/// So many reflectances of nearly one colour under D65 and of different spectra.
Samples metamers(int count, double apart, unsigned seed) {
  std::mt19937 random(seed);
  const Eigen::Matrix3Xd weights = normalisedWeights("D65", kConvergedBandCount);
  const Eigen::Matrix3d inverse = (weights * weights.transpose()).inverse();
  const spectral::DomainSamples common = samplesOf("colorchecker")[1];  // a light skin
  Samples samples;
  for (int i = 0; i < count; ++i) {
    spectral::DomainSamples wave = spectral::DomainSamples::Zero();
    for (int harmonic = 2; harmonic <= 6; ++harmonic) {
      const double phase = 2.0 * std::numbers::pi * unitRandom(random);
      for (int k = 0; k < spectral::kDomainSize; ++k) {
        wave[k] += std::cos(std::numbers::pi * harmonic * k / 400.0 + phase);
      }
    }
    const spectral::DomainSamples black = wave - weights.transpose() * (inverse * (weights * wave));
    const double size = 0.12 / black.cwiseAbs().maxCoeff();
    samples.emplace_back((common + size * black + apart * unitRandom(random) * wave).cwiseMax(0.0).cwiseMin(1.0));
  }
  return samples;
}

void expectExact(const Samples& pairs, int& limitedBelow) {
  for (const auto& [in, out] : lightPairs()) {
    for (const Kind over : {Kind::Natural, Kind::Smooth}) {
      const TransformSpec spec = withPairs(in, out, over, pairs);
      const SpectralTransform transform(spec, kConvergedBandCount);
      const SpectralTransform without(below(spec), kConvergedBandCount);
      spectral::MaxDifference largest(in + " to " + out + ": pairs", 1e-7);
      for (const spectral::DomainSamples& pair : pairs) {
        const Vector3d rgb = inputRgb(spec, transform, pair);
        limitedBelow += transform.linearise(rgb).isLimited ? 1 : 0;
        // At any exposure.
        largest.add(transform.apply(0.25 * rgb), 0.25 * outputRgb(spec, pair));
      }
      EXPECT_EQ(transform.knownColours().size(), pairs.size());
      // Neutrals stay on the perfect reflector.
      EXPECT_LE((transform.apply(Vector3d::Ones()) - without.apply(Vector3d::Ones())).norm(), 1e-12);
    }
  }
}

TEST(PairsSceneTest, ColoursWithTheirSpectraComeOutExactly) {
  int limitedBelow = 0;
  expectExact(samplesOf("colorchecker"), limitedBelow);
  expectExact(blocks(), limitedBelow);
  // Else nothing here says that the limiter leaves pairs alone.
  EXPECT_GT(limitedBelow, 5);
}

TEST(PairsSceneTest, FarAwayIsTheSceneBelow) {
  Samples one = {samplesOf("colorchecker")[14]};  // a red
  TransformSpec spec = withPairs("D65", "HP1", Kind::Natural, one);
  spec.scene.radius = 0.2;
  const SpectralTransform transform(spec);
  const SpectralTransform without(below(spec));
  // Limits are set by the surfaces, of which the pair is one more: a hair.
  const Vector3d near = inputRgb(spec, transform, one[0]);
  EXPECT_GT(difference(transform, transform.apply(near), without.apply(near)), 0.1);
  for (const char* const set : {"colorchecker", "pmc"}) {
    int far = 0;
    for (const spectral::DomainSamples& sample : samplesOf(set)) {
      const Vector3d rgb = inputRgb(spec, transform, sample);
      if (difference(transform, rgb / rgb.sum(), near / near.sum()) > 15.0) {
        ++far;
        EXPECT_LE((transform.apply(rgb) - without.apply(rgb)).norm(), 1e-12);
      }
    }
    EXPECT_GE(far, 12) << set;
  }
}

TEST(PairsSceneTest, DerivativeAgainstDifferences) {
  Samples pairs = samplesOf("colorchecker");
  const Samples odd = blocks();
  pairs.insert(pairs.end(), odd.begin(), odd.end());
  const Samples alike = metamers(3, 2e-3, 5);
  pairs.insert(pairs.end(), alike.begin(), alike.end());
  for (const Kind over : {Kind::Natural, Kind::Smooth}) {
    const TransformSpec spec = withPairs("D65", "HP1", over, pairs);
    const SpectralTransform transform(spec);
    std::vector<Vector3d> colours;
    std::mt19937 random(2);
    for (const spectral::DomainSamples& pair : pairs) {
      const Vector3d rgb = inputRgb(spec, transform, pair);
      for (const double away : {1e-3, 3e-2, 0.2}) {
        colours.emplace_back(rgb +
                             away * rgb.sum() * Vector3d(unitRandom(random), unitRandom(random), unitRandom(random)));
      }
    }
    int unlike = 0;
    for (const Vector3d& rgb : colours) {
      const auto local = transform.linearise(rgb);
      EXPECT_LE((local.matrix * rgb - local.value).norm(), 1e-9 * local.value.norm());
      const Vector3d step = 1e-7 * Vector3d(1, -2, 3);
      const Vector3d change = transform.apply(rgb + step) - transform.apply(rgb - step);
      // A band that begins to be clamped, or a limit to be felt, is seldom this near.
      unlike += (change - 2.0 * local.matrix * step).norm() > 1e-5 * change.norm() ? 1 : 0;
    }
    EXPECT_LE(unlike, static_cast<int>(colours.size()) / 20);
  }
}

/// How many of a fine grid of colours round some turn over.
int foldsRound(const SpectralTransform& transform, const Vector3d& centre, double reach) {
  int folds = 0;
  for (int i = -10; i <= 10; ++i) {
    for (int j = -10; j <= 10; ++j) {
      const Vector3d rgb = centre + centre.sum() * reach / 10.0 * (i * Vector3d(1, -1, 0) + j * Vector3d(0, 1, -1));
      folds += transform.linearise(rgb).matrix.determinant() < 0.0 ? 1 : 0;
    }
  }
  return folds;
}

TEST(PairsSceneTest, PairsInConflictAreNoWorseThanNone) {
  const Samples chart = samplesOf("tm30");
  for (const unsigned seed : {1U, 2U}) {
    for (const char* const out : {"A", "HP1", "LED-RGB1"}) {
      Samples pairs = metamers(16, 1e-4, seed);
      const TransformSpec spec = withPairs("D65", out, Kind::Natural, pairs);
      const SpectralTransform transform(spec, 81);
      const SpectralTransform without(below(spec), 81);
      EXPECT_TRUE(transform.knownColours().empty());
      double worse = 0.0;
      Samples judged = pairs;
      judged.insert(judged.end(), chart.begin(), chart.end());
      for (const spectral::DomainSamples& sample : judged) {
        const Vector3d rgb = inputRgb(spec, transform, sample);
        const Vector3d truth = outputRgb(spec, sample);
        worse = std::max(worse, difference(transform, transform.apply(rgb), truth) -
                                    difference(transform, without.apply(rgb), truth));
      }
      EXPECT_LE(worse, 1.0) << out << ", seed " << seed;
      const Vector3d centre = inputRgb(spec, transform, pairs[0]);
      for (const double reach : {1e-4, 1e-3, 1e-2, 1e-1}) {
        EXPECT_LE(foldsRound(transform, centre, reach), foldsRound(without, centre, reach)) << out << ' ' << reach;
      }
      const std::vector<std::string> notes = notesOfPairs(spec);
      ASSERT_EQ(notes.size(), 4U);  // three named, and how many more
      EXPECT_NE(notes[0].find("have two spectra for one colour"), std::string::npos) << notes[0];
    }
  }
}

TEST(PairsSceneTest, TheMapHoldsAtPairs) {
  for (const Kind over : {Kind::Natural, Kind::Smooth}) {
    const TransformSpec spec = withPairs("D65", "A", over, samplesOf("colorchecker"));
    const SpectralTransform transform(spec);
    const HomogeneousMap map = buildHomogeneousMap(transform);
    const std::vector<Vector3d> known = transform.knownColours();
    ASSERT_EQ(known.size(), 24U);
    double most = 0.0;
    for (const Vector3d& rgb : known) {
      const Vector3d exact = transform.apply(rgb);
      const Vector3d scaled = rgb * (0.18 / (transform.space().xyzFromRgb() * rgb).y());
      std::array<float, 4> pixel = {static_cast<float>(scaled.x()), static_cast<float>(scaled.y()),
                                    static_cast<float>(scaled.z()), 1.0F};
      map.apply(pixel);
      const Vector3d mapped = Eigen::Map<const Eigen::Vector3f>(pixel.data()).cast<double>();
      most = std::max(most, difference(transform, mapped, exact * (scaled.sum() / rgb.sum())));
    }
    // Its tolerance; refinement goes by CIEDE2000's limit for small differences, within a tenth of the formula.
    EXPECT_LE(most, 1.1 * kDefaultMapTolerance);
  }
}

TEST(PairsSceneTest, HardPairs) {
  const Samples chart = samplesOf("colorchecker");
  TransformSpec spec = withPairs("D65", "A", Kind::Natural, {chart[0], spectral::DomainSamples::Zero()});
  spec.scene.pairNames = {"brown", "black"};
  const SpectralTransform transform(spec, kConvergedBandCount);
  EXPECT_EQ(transform.knownColours().size(), 1U);
  EXPECT_EQ(notesOfPairs(spec), std::vector<std::string>{"'black' is black under the input light, and is left out"});
  const std::vector<CheckedPair> checked = checkPairs(spec);
  ASSERT_EQ(checked.size(), 2U);
  EXPECT_LE(checked[0].error, 1e-6);
  EXPECT_GT(checked[0].errorBefore, 0.01);
  EXPECT_EQ(checked[0].nearest, "white");
  EXPECT_TRUE(checked[0].conflicts.empty());
  EXPECT_TRUE(checked[1].isDark);

  // A metamer of white: white stays.
  Samples white = metamers(1, 0.0, 1);
  white[0] += spectral::DomainSamples::Constant(0.5) - chart[1];
  spec.scene.pairs = white;
  spec.scene.pairNames = {};
  const SpectralTransform nearWhite(spec);
  EXPECT_LE((nearWhite.apply(Vector3d::Ones()) - SpectralTransform(below(spec)).apply(Vector3d::Ones())).norm(), 1e-12);
  EXPECT_NE(notesOfPairs(spec).at(0).find("'pair 1' is 0"), std::string::npos) << notesOfPairs(spec).at(0);

  spec.scene.pairs = {spectral::DomainSamples::Constant(1.1) - chart[3]};
  EXPECT_NE(notesOfPairs(spec).at(0).find("reflects up to 1.0"), std::string::npos);
  spec.scene.pairs.clear();
  EXPECT_NE(errorOf([&] { SpectralTransform bad(spec); }).find("scene.pairs '0': give from 1 to 16384"),
            std::string::npos);
  spec.scene.pairs = chart;
  spec.scene.radius = 0.0;
  EXPECT_NE(errorOf([&] { SpectralTransform bad(spec); }).find("scene.radius"), std::string::npos);
  spec.scene.radius = 1.0;
  spec.scene.over = Kind::Dataset;
  EXPECT_NE(errorOf([&] { SpectralTransform bad(spec); }).find("scene.over 'dataset'"), std::string::npos);
}

TEST(PairsSceneTest, ThousandsOfPairs) {
  Samples many;
  std::mt19937 random(4);
  const Samples surfaces = samplesOf("tm30");
  for (int i = 0; i < 3000; ++i) {
    const auto any = [&] { return surfaces[random() % surfaces.size()]; };
    const double part = unitRandom(random);
    many.emplace_back(part * any() + (1.0 - part) * any());
  }
  const auto start = std::chrono::steady_clock::now();
  const TransformSpec spec = withPairs("D65", "A", Kind::Natural, many);
  const SpectralTransform transform(spec, 81);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  std::printf("[ pairs    ] %zu of 3000 exact, %.2f s\n", transform.knownColours().size(), taken.count());
  for (const Vector3d& colour : colours(100)) {
    ASSERT_TRUE(transform.apply(colour).allFinite());
  }
}

}  // namespace
}  // namespace metamer::sip
