// SPDX-License-Identifier: Apache-2.0
#include "scenes/uplift_scene.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "metamer/sip/error_protocol.h"
#include "metamer/sip/homogeneous_map.h"
#include "metamer/sip/recipe.h"
#include "metamer/spectral/colorimetry.h"
#include "sip/transform/transform_fixture.h"
#include "spectral/fixture.h"

namespace metamer::sip {
namespace {

using Eigen::Vector3d;
using Kind = ReferenceScene::Kind;

constexpr int kBands = 81;

TransformSpec specOfUplift(Kind kind, const char* from, const char* to, const char* space = "Rec.709") {
  Recipe recipe;
  recipe.space = space;
  recipe.input.illuminant = from;
  recipe.output.illuminant = to;
  recipe.adaptation = 1.0;
  recipe.scene.kind = kind;
  return resolve(recipe, spectral::testLibrary());
}

UpliftScene sceneOf(const TransformSpec& spec, const SoftBoundSolver& solver) {
  return {solver, spec.scene.uplift, onBands(spec.scene.samples, solver.bandCount()), spec.scene.sampleColours};
}

class UpliftSceneTest : public testing::TestWithParam<Kind> {};

// Where the uplift was made for, its spectrum comes out: with the smooth part of the colour, the deviation is all of
// it.
TEST_P(UpliftSceneTest, UnderDaylightIsTheUpliftsSpectrum) {
  const TransformSpec spec = specOfUplift(GetParam(), "D65", "A");
  const SoftBoundSolver solver(normalisedWeights("D65", kBands));
  const UpliftScene scene = sceneOf(spec, solver);
  const spectral::Uplift& uplift = *spec.scene.uplift;
  const auto count = static_cast<Eigen::Index>(uplift.wavelengthsNm().size());
  // What white lacks of the perfect reflector is taken off by a colour's share of it.
  const Vector3d half = Vector3d::Constant(UpliftScene::kBrightness);
  Eigen::VectorXd white(count);
  uplift.spectra({half.data(), 3}, {white.data(), static_cast<std::size_t>(count)});
  double largest = 0.0;
  for (const Vector3d& rgb : {Vector3d(0.5, 0.3, 0.21), Vector3d(0.1, 0.5, 0.2), Vector3d(0.2, 0.25, 0.5)}) {
    Eigen::VectorXd exact(count);
    uplift.spectra({rgb.data(), 3}, {exact.data(), static_cast<std::size_t>(count)});
    exact += rgb.minCoeff() * (Eigen::VectorXd::Ones(count) - white / UpliftScene::kBrightness);
    const spectral::Spectrum spectrum("uplift", spectral::SpectralQuantity::Reflectance, uplift.wavelengthsNm(),
                                      {exact.data(), exact.data() + count});
    const Eigen::VectorXd bands = atBandCentres(spectrum.onDomain(), kBands);
    const Vector3d white709 = uplift.xyzFromRgb() * Vector3d::Ones();
    const Vector3d response = (uplift.xyzFromRgb() * rgb).cwiseQuotient(white709);
    // The uplift's own miss of the colour is spread smoothly.
    const Eigen::VectorXd met = bands + solver.unclamped() * (response - solver.weights() * bands);
    const Eigen::VectorXd found = solver.unclamped() * response + scene.deviation(response);
    largest = std::max(largest, (found - met).cwiseAbs().maxCoeff());
  }
  std::printf("[ uplift ] %s: at most %.2g off its spectra\n", nameOf(GetParam()).c_str(), largest);
  EXPECT_LE(largest, 2e-3);
}

TEST_P(UpliftSceneTest, HasNoResponseAndScales) {
  const TransformSpec spec = specOfUplift(GetParam(), "FL11", "D65");
  const SoftBoundSolver solver(normalisedWeights("FL11", kBands));
  const UpliftScene scene = sceneOf(spec, solver);
  EXPECT_LE(scene.deviation(Vector3d::Ones()).cwiseAbs().maxCoeff(), 1e-12);
  for (const Vector3d& response : colours(60)) {
    const BandVector deviation = scene.deviation(response);
    const double size = deviation.cwiseAbs().maxCoeff();
    EXPECT_LE((solver.weights() * deviation).cwiseAbs().maxCoeff(), 1e-12 * std::max(1.0, size));
    EXPECT_EQ(scene.deviation(4.0 * response), 4.0 * deviation);
    const UpliftScene::Local local = scene.local(response);
    EXPECT_EQ(local.value, deviation);
    EXPECT_LE((local.slope * response - deviation).norm(), 1e-9 * (1.0 + deviation.norm()));
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Vector3d& odd : {Vector3d(nan, 1, 1), Vector3d(0, 0, 0), Vector3d(-1, -1, -1)}) {
    EXPECT_TRUE(scene.deviation(odd).isZero(0.0));
    EXPECT_TRUE(scene.local(odd).slope.isZero(0.0));
  }
}

/// The steepest change of the deviation from white outwards, a step of 1 in chromaticity.
double steepest(const UpliftScene& scene) {
  constexpr double kStep = 1e-4;
  double steepest = 0.0;
  for (int ray = 0; ray < 6; ++ray) {
    const Vector3d direction(std::cos(ray), std::sin(ray), -std::cos(ray) - std::sin(ray));
    BandVector before = scene.deviation(Vector3d::Constant(1.0 / 3.0));
    for (int k = 1; k < 4000; ++k) {
      const BandVector here = scene.deviation(Vector3d::Constant(1.0 / 3.0) + k * kStep * direction);
      steepest = std::max(steepest, (here - before).norm() / kStep);
      before = here;
    }
  }
  return steepest;
}

TEST(UpliftSceneNamesTest, OtsuJumpsWhereTheOthersDoNot) {
  const SoftBoundSolver solver(normalisedWeights("D65", kBands));
  for (const Kind kind : {Kind::Smits, Kind::Mallett, Kind::Jakob}) {
    const double change = steepest(sceneOf(specOfUplift(kind, "D65", "A"), solver));
    std::printf("[ uplift ] %s: deviation changes by at most %.3g\n", nameOf(kind).c_str(), change);
    EXPECT_LE(change, 100.0) << nameOf(kind);
  }
  TransformSpec otsu = specOfUplift(Kind::Smits, "D65", "A");
  otsu.scene.uplift = spectral::makeUplift(spectral::UpliftMethod::Otsu, spectral::testLibrary());
  const double change = steepest(sceneOf(otsu, solver));
  std::printf("[ uplift ] otsu: deviation changes by at most %.3g\n", change);
  EXPECT_GE(change, 1000.0);
}

TEST_P(UpliftSceneTest, TransformsAndItsMapHoldsItsTolerance) {
  const TransformSpec spec = specOfUplift(GetParam(), "D65", "A", "ACEScg");
  const SpectralTransform transform(spec, kBands);
  const SpectralTransform same(specOfUplift(GetParam(), "D65", "D65", "ACEScg"), kBands);
  EXPECT_LE((transform.apply(Vector3d::Ones()) - Vector3d::Ones()).cwiseAbs().maxCoeff(), 1e-9);
  for (const Vector3d& colour : colours(400)) {
    EXPECT_EQ(same.apply(colour), colour);
    const Vector3d exact = transform.apply(colour);
    ASSERT_TRUE(exact.allFinite()) << colour.transpose();
    EXPECT_LE((transform.apply(0.5 * colour) - 0.5 * exact).norm(), 1e-9 * exact.norm());
  }
  if (GetParam() == Kind::Meng) {
    return;  // seconds
  }
  const HomogeneousMap map = buildHomogeneousMap(transform);
  const auto report =
      ErrorProtocol(spec, chart()).measureAgainst(transform, [&](std::span<float> rgba) { map.apply(rgba); });
  std::printf("[ uplift ] %s: map p99 %.3f, max %.3f\n", nameOf(GetParam()).c_str(), report.p99, report.max);
  EXPECT_LE(report.p99, 0.1);
  EXPECT_LE(report.max, 1.0);
}

INSTANTIATE_TEST_SUITE_P(Methods, UpliftSceneTest, testing::Values(Kind::Smits, Kind::Mallett, Kind::Jakob, Kind::Meng),
                         [](const auto& instance) { return nameOf(instance.param); });

TEST(UpliftSceneNamesTest, OtsuIsRefusedAndSaysWhy) {
  EXPECT_NE(errorOf([] { sceneKindFromName("otsu"); }).find("jumps"), std::string::npos);
  EXPECT_NE(errorOf([] {
              parseRecipe(
                  "metamer: 1\ninput: {illuminant: D65}\noutput: {illuminant: A}\n"
                  "scene: {kind: otsu}\n",
                  "look.yaml");
            }).find("look.yaml:4"),
            std::string::npos);
}

}  // namespace
}  // namespace metamer::sip
