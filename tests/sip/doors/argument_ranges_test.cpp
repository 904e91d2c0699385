// SPDX-License-Identifier: Apache-2.0
// Every public function of sip that has a range, with arguments just outside it and just inside.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "metamer/sip/band_weights.h"
#include "metamer/sip/comparison.h"
#include "metamer/sip/error_protocol.h"
#include "metamer/sip/homogeneous_map.h"
#include "metamer/sip/probe_limits.h"
#include "metamer/sip/recipe.h"
#include "metamer/sip/smoothest_spectrum.h"
#include "metamer/sip/spectral_locus.h"
#include "sip/sip_fixture.h"
#include "spectral/refusals.h"

namespace metamer::sip {
namespace {

using spectral::DomainSamples;

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

const TransformSpec& spec() {
  static const TransformSpec spec = specOf("D65", "A");
  return spec;
}

const SpectralTransform& coarse() {
  static const SpectralTransform transform(spec(), kMinimumBandCount);
  return transform;
}

TEST(SipRanges, Bands) {
  const DomainSamples light = DomainSamples::Ones();
  const Eigen::Matrix<double, spectral::kDomainSize, 3> curves =
      Eigen::Matrix<double, spectral::kDomainSize, 3>::Ones();
  for (const int bands : {-1, 0, 1, 4, kMinimumBandCount - 1, kConvergedBandCount + 1, 500, 1000}) {
    const std::string said = "'" + std::to_string(bands) + "': must be from 16 to 401";
    EXPECT_REFUSED(said, SpectralTransform(spec(), bands));
    EXPECT_REFUSED(said, bandWeights(light, curves, bands));
    EXPECT_REFUSED(said, atBandCentres(light, bands));
    EXPECT_REFUSED(said, bandCentreNm(0, bands));
  }
  for (const int bands : {kMinimumBandCount, kConvergedBandCount}) {
    EXPECT_TAKEN(SpectralTransform(spec(), bands));
    EXPECT_TAKEN(bandWeights(light, curves, bands));
    EXPECT_TAKEN(atBandCentres(light, bands));
    EXPECT_EQ(bandCentreNm(bands - 1, bands), 780.0);
    EXPECT_REFUSED("band '-1'", bandCentreNm(-1, bands));
    EXPECT_REFUSED("band '" + std::to_string(bands) + "'", bandCentreNm(bands, bands));
  }
}

TEST(SipRanges, SmoothestSpectrum) {
  using Solver = SmoothestSpectrumSolver;
  EXPECT_TAKEN(Solver(Eigen::Matrix3Xd::Ones(3, Solver::kFewestBands)));
  EXPECT_TAKEN(Solver(normalisedWeights("D65", kConvergedBandCount)));
  EXPECT_REFUSED("bands of the weights '3'", Solver(Eigen::Matrix3Xd::Ones(3, Solver::kFewestBands - 1)));
  EXPECT_REFUSED("bands of the weights '402'", Solver(Eigen::Matrix3Xd::Ones(3, kConvergedBandCount + 1)));
  const Solver solver(normalisedWeights("D65", 41));
  const Eigen::Vector3d grey = Eigen::Vector3d::Constant(0.5);
  const auto solved = [&](int values) {
    const Eigen::VectorXd prior = Eigen::VectorXd::Constant(values, 0.5);
    return solver.solve(grey, &prior);
  };
  EXPECT_TAKEN(solved(41));
  EXPECT_REFUSED("prior '40'", solved(40));
  EXPECT_REFUSED("prior '42'", solved(42));
  EXPECT_TAKEN(solver.linearise(grey, Eigen::MatrixX3d::Ones(41, 3)));
  EXPECT_REFUSED("functionals '40'", solver.linearise(grey, Eigen::MatrixX3d::Ones(40, 3)));
  const Solver bounded(normalisedWeights("D65", 41), Solver::UpperBound::One);
  EXPECT_REFUSED("upper bound", bounded.linearise(grey, Eigen::MatrixX3d::Ones(41, 3)));
}

TEST(SipRanges, Specifications) {
  const auto with = [](const std::function<void(TransformSpec&)>& change) {
    TransformSpec changed = spec();
    change(changed);
    return SpectralTransform(changed, kMinimumBandCount);
  };
  for (const double adaptation : {-1e-9, 1 + 1e-9, kNotANumber}) {
    EXPECT_REFUSED("adaptation", with([&](auto& changed) { changed.adaptation = adaptation; }));
  }
  EXPECT_TAKEN(with([](auto& changed) { changed.adaptation = 1; }));
  const spectral::Spectrum clear("clear", spectral::SpectralQuantity::Transmittance, {380, 780}, {1, 1});
  EXPECT_REFUSED("density", with([&](auto& changed) { changed.output.filters = {{clear, -1e-9}}; }));
  EXPECT_REFUSED("density", with([&](auto& changed) { changed.output.filters = {{clear, kNotANumber}}; }));
  EXPECT_TAKEN(with([&](auto& changed) { changed.output.filters = {{clear, 0}}; }));
  const auto skin = [&](double strength, double fade = kDefaultSkinFade, std::size_t virtualSkins = 24) {
    return with([&](auto& changed) {
      const std::vector<DomainSamples> chart = samplesOf("colorchecker");
      changed.scene = {ReferenceScene::Kind::Skin, chart, {}, strength, chart, fade};
      changed.scene.virtualSkins.resize(virtualSkins);
    });
  };
  EXPECT_TAKEN(skin(0));
  EXPECT_TAKEN(skin(1, kLeastSkinFade, 4));
  EXPECT_TAKEN(skin(1, kLargestSkinFade));
  EXPECT_REFUSED("scene.fade", skin(1, kLeastSkinFade - 1e-9));
  EXPECT_REFUSED("scene.fade", skin(1, kLargestSkinFade + 1e-9));
  EXPECT_REFUSED("scene.fade", skin(1, kNotANumber));
  EXPECT_REFUSED("scene.virtualSkins", skin(1, kDefaultSkinFade, 3));
  EXPECT_REFUSED("scene.strength", skin(-1e-9));
  EXPECT_REFUSED("scene.strength", skin(1 + 1e-9));
  EXPECT_REFUSED("scene.set", with([](auto& changed) { changed.scene = {ReferenceScene::Kind::Natural, {}}; }));
  const auto camera = testLibrary().observer("Canon EOS 5D Mark II");
  EXPECT_REFUSED("training '2'",
                 prepare({spec().input.illuminant, {}, {"camera", camera.response, camera.curves, {}}},
                         std::vector<DomainSamples>(2, DomainSamples::Ones()), spec().standardObserver));
  EXPECT_REFUSED("must be natural", sceneKindFromName("natural "));
  EXPECT_REFUSED("must be camera", balanceFromName("cat03"));
}

TEST(SipRanges, Pixels) {
  std::vector<float> pixels(11, 0.5F);
  const std::span<float> half(pixels.data(), 7);
  const std::span<float> one(pixels.data(), 4);
  const std::span<float> two(pixels.data(), 8);
  EXPECT_REFUSED("pixels '7'", (coarse().apply(half), 0));
  EXPECT_TAKEN((coarse().apply(two), 0));

  const HomogeneousMap map = buildHomogeneousMap(SpectralTransform(specOf("D65", "D65"), kMinimumBandCount));
  EXPECT_TAKEN((map.apply(two), 0));
  EXPECT_REFUSED("pixels '7'", (map.apply(half), 0));
  EXPECT_REFUSED("destination '4'", (map.apply(two, one), 0));
  EXPECT_REFUSED("destination '8'", (map.apply(one, two), 0));

  EXPECT_TAKEN(comparePixels(spec().space, two, two));
  EXPECT_REFUSED("pixels '7'", comparePixels(spec().space, half, half));
  EXPECT_REFUSED("second picture '4'", comparePixels(spec().space, two, one));
}

TEST(SipRanges, Maps) {
  EXPECT_REFUSED("tolerance '0'", buildHomogeneousMap(coarse(), 0));
  EXPECT_REFUSED("tolerance '-1'", buildHomogeneousMap(coarse(), -1));
  EXPECT_REFUSED("tolerance 'nan'", buildHomogeneousMap(coarse(), kNotANumber));
  EXPECT_REFUSED("fewerLevels '-1'", buildHomogeneousMap(coarse(), 0.5, inOrder, nullptr, -1));
  EXPECT_REFUSED("fewerLevels '8'",
                 buildHomogeneousMap(coarse(), 0.5, inOrder, nullptr, HomogeneousMap::kMaximumDepth + 1));
  EXPECT_TAKEN(buildHomogeneousMap(coarse(), 0.5, inOrder, nullptr, HomogeneousMap::kMaximumDepth));
}

TEST(SipRanges, Judgements) {
  const auto judged = [](const ErrorProtocol::Options& options) { return ErrorProtocol(spec(), {}, options); };
  EXPECT_TAKEN(judged({.chromaticityCount = 0, .ringCount = 0, .lowestStop = -kMostStops, .highestStop = kMostStops}));
  EXPECT_REFUSED("chromaticities '-1'", judged({.chromaticityCount = -1}));
  EXPECT_REFUSED("chromaticities", judged({.chromaticityCount = kMostProbes + 1}));
  EXPECT_REFUSED("ring '-1'", judged({.ringCount = -1}));
  EXPECT_REFUSED("ring", judged({.ringCount = kMostProbes + 1}));
  EXPECT_REFUSED("lowest stop '-25'", judged({.lowestStop = -25}));
  EXPECT_REFUSED("highest stop '25'", judged({.highestStop = 25}));
  EXPECT_REFUSED("lowest stop '3'", judged({.lowestStop = 3, .highestStop = 2}));

  const auto nothing = [](std::span<float>) {};
  const auto compared = [&](int lowest, int highest) {
    return compareTransforms(spec().space, {{"grey", Eigen::Vector3d::Ones()}}, lowest, highest, nothing, nothing);
  };
  EXPECT_TAKEN(compared(0, 0));
  EXPECT_REFUSED("lowest stop '1'", compared(1, 0));
  EXPECT_REFUSED("lowest stop '-25'", compared(-25, 0));
  EXPECT_REFUSED("highest stop '25'", compared(0, 25));

  EXPECT_TAKEN(SpectralLocus(spec().standardObserver));
  EXPECT_REFUSED("observer", SpectralLocus(testLibrary().observer("Canon EOS 5D Mark II")));
}

TEST(SipRanges, Recipes) {
  const auto parsed = [](const std::string& more) {
    return parseRecipe("metamer: 1\ninput: {illuminant: D65}\noutput: {illuminant: A}\n" + more, "r.yaml");
  };
  EXPECT_TAKEN(parsed("scene: {kind: skin, strength: 1}"));
  EXPECT_REFUSED("strength", parsed("scene: {kind: skin, strength: 1.001}"));
  EXPECT_REFUSED("strength", parsed("scene: {kind: skin, strength: -0.001}"));
  EXPECT_REFUSED("size", parseRecipe(std::string(kLargestRecipeBytes + 1, ' '), "r.yaml"));
  EXPECT_REFUSED("r.yaml", parseRecipe("metamer: 2", "r.yaml"));
  EXPECT_REFUSED("none.yaml", readRecipe("/nonexistent/none.yaml"));
  Recipe recipe = parsed("");
  recipe.output.illuminant = "D6";
  EXPECT_REFUSED("near names", resolve(recipe, testLibrary()));
}

}  // namespace
}  // namespace metamer::sip
