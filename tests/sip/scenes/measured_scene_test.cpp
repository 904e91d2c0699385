// SPDX-License-Identifier: Apache-2.0
#include "scenes/measured_scene.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "metamer/spectral/colorimetry.h"
#include "sip/transform/transform_fixture.h"

namespace metamer::sip {
namespace {

using Eigen::Vector3d;

constexpr int kBands = 81;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A chart under a light.
struct ChartScene {
  explicit ChartScene(const char* light, double noise = 0.2)
      : solver(normalisedWeights(light, kBands)),
        reflectances(onBands(samplesOf("colorchecker"), kBands)),
        scene(solver, reflectances, Eigen::VectorXd::Constant(reflectances.cols(), noise)) {}

  Vector3d response(Eigen::Index sample) const { return solver.weights() * reflectances.col(sample); }

  SoftBoundSolver solver;
  Eigen::MatrixXd reflectances;
  MeasuredScene scene;
};

TEST(MeasuredSceneTest, DeviationsHaveNoResponse) {
  for (const char* const light : {"D65", "HP1", "LED-RGB1"}) {
    const ChartScene chart(light);
    spectral::MaxDifference response(std::string(light) + ": response of a deviation", 1e-12);
    for (const Vector3d& colour : colours(300)) {
      const BandVector deviation = chart.scene.deviation(colour);
      response.add(chart.solver.weights() * deviation, Vector3d(Vector3d::Zero()));
    }
    EXPECT_GT(chart.scene.deviation(chart.response(4)).norm(), 0.01);
  }
}

TEST(MeasuredSceneTest, NeutralsHaveNoDeviation) {
  for (const char* const light : {"D65", "HP1", "FL11"}) {
    const ChartScene chart(light);
    for (const double grey : {1e-9, 0.18, 1.0, 1e9}) {
      EXPECT_LE(chart.scene.deviation(Vector3d::Constant(grey)).cwiseAbs().maxCoeff(), 1e-12 * grey) << light;
    }
  }
}

TEST(MeasuredSceneTest, FadesFarFromAllSamples) {
  const ChartScene chart("D65");
  double nearSamples = 0.0;
  for (Eigen::Index i = 0; i < chart.reflectances.cols(); ++i) {
    const Vector3d response = chart.response(i);
    nearSamples = std::max(nearSamples, chart.scene.deviation(response).norm() / response.norm());
  }
  for (const Vector3d& direction : {Vector3d(1, -1, 0), Vector3d(-1, 0, 1), Vector3d(0, 1, -1)}) {
    double before = kInfinity;
    for (const double distance : {4.0, 6.0, 8.0, 16.0}) {
      const double size = chart.scene.deviation(Vector3d::Ones() + distance * direction).norm();
      EXPECT_LT(size, before) << direction.transpose();
      before = size;
    }
    EXPECT_LT(before, 1e-3 * nearSamples) << direction.transpose();
    // And without a step to where its mean is zero or below.
    EXPECT_LT(chart.scene.deviation(direction + Vector3d::Constant(1.001e-4)).norm(), 1e-12);
    EXPECT_TRUE(chart.scene.deviation(direction).isZero(0.0));
  }
}

TEST(MeasuredSceneTest, DerivativeAgainstDifferences) {
  const ChartScene chart("FL11");
  spectral::MaxDifference difference("derivative of a deviation", 1e-7);
  spectral::MaxDifference homogeneity("slope times colour", 1e-12);
  for (const Vector3d& colour : colours(300)) {
    const MeasuredScene::Local local = chart.scene.local(colour);
    EXPECT_LE((local.value - chart.scene.deviation(colour)).cwiseAbs().maxCoeff(), 1e-13);
    homogeneity.add(local.slope * colour, local.value);
    if (colour.mean() < 1e-3) {
      continue;
    }
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Vector3d step = 1e-6 * colour.norm() * Vector3d::Unit(k);
      const BandVector change = chart.scene.deviation(colour + step) - chart.scene.deviation(colour - step);
      difference.add(change / (2.0 * step[k]), local.slope.col(k));
    }
  }
}

TEST(MeasuredSceneTest, HomogeneousOfDegreeOne) {
  const ChartScene chart("HP1");
  for (const Vector3d& colour : colours(100)) {
    const BandVector expected = chart.scene.deviation(colour);
    EXPECT_EQ(chart.scene.deviation(1024.0 * colour), BandVector(1024.0 * expected));
    for (const double exposure : {1e-30, 1e30}) {
      EXPECT_LE((chart.scene.deviation(exposure * colour) / exposure - expected).norm(), 1e-12);
    }
  }
}

TEST(MeasuredSceneTest, ASampleWithoutNoiseIsMetExactly) {
  for (const char* const light : {"D65", "HP1"}) {
    const ChartScene smoothed(light);
    Eigen::VectorXd noise = Eigen::VectorXd::Constant(smoothed.reflectances.cols(), 0.2);
    const std::vector<Eigen::Index> pinned = {4, 7, 13};
    for (const Eigen::Index i : pinned) {
      noise[i] = 0.0;
    }
    const MeasuredScene scene(smoothed.solver, smoothed.reflectances, noise);
    for (const Eigen::Index i : pinned) {
      const Vector3d response = smoothed.response(i);
      const Eigen::VectorXd own = smoothed.reflectances.col(i);
      const Eigen::VectorXd smooth = smoothed.solver.unclamped() * response;
      EXPECT_LE((smooth + scene.deviation(response) - own).norm(), 1e-10) << light << " " << i;
      // With noise it is nearer than the smooth spectrum, but not there.
      const double missed = (smooth + smoothed.scene.deviation(response) - own).norm();
      EXPECT_GT(missed, 1e-3) << light << " " << i;
      EXPECT_LT(missed, (smooth - own).norm()) << light << " " << i;
    }
  }
}

/// The Gaussian process with all samples, by dense algebra: kernels of a place with white and the samples, solved.
Eigen::VectorXd deviationByAll(const MeasuredSeeds& seeds, const SoftBoundSolver& solver,
                               const Eigen::MatrixXd& reflectances, const Vector3d& response) {
  const Eigen::Index count = reflectances.cols();
  Eigen::Matrix3Xd responses(3, count + 1);
  responses << Vector3d::Ones(), solver.weights() * reflectances;
  const Eigen::RowVectorXd means = responses.colwise().mean();
  const Eigen::ArrayX2d places = ((seeds.differences * responses).array().rowwise() / means.array()).transpose();
  const SampleKernel kernel(places);
  Eigen::MatrixXd system(count + 1, count + 1);
  for (Eigen::Index i = 0; i <= count; ++i) {
    system.col(i) = kernel.values(places.row(i).transpose()).head(count + 1);
    const double dark = 0.05 / means[i];
    system(i, i) += i == 0 ? 0.0 : 0.2 * (1.0 + dark * dark);
  }
  Eigen::MatrixXd deviations = Eigen::MatrixXd::Zero(kBands, count + 1);
  deviations.rightCols(count) = reflectances - solver.unclamped() * responses.rightCols(count);
  const Eigen::VectorXd at = kernel.values(seeds.differences * response / response.mean()).head(count + 1);
  const Eigen::VectorXd weights = system.ldlt().solve(at);
  return response.mean() * (deviations.array().rowwise() / means.array()).matrix() * weights;
}

TEST(MeasuredSceneTest, FewSamplesStandForThemselvesAndSomeOfManyForAll) {
  for (const char* const light : {"D65", "HP1"}) {
    const ChartScene chart(light);
    const MeasuredSeeds own(chart.solver.weights(), chart.reflectances, Eigen::VectorXd::Constant(24, 0.2));
    ASSERT_EQ(own.places.rows(), 25);
    const Eigen::MatrixXd many = onBands(samplesOf("rawtoaces 190"), kBands);
    const Eigen::VectorXd noise = Eigen::VectorXd::Constant(many.cols(), 0.2);
    const MeasuredSeeds seeds(chart.solver.weights(), many, noise);
    ASSERT_EQ(seeds.places.rows(), MeasuredSeeds::kMostSeeds);
    const MeasuredScene scene(chart.solver, seeds);
    double largest = 0.0;
    for (Eigen::Index i = 0; i < chart.reflectances.cols(); ++i) {
      const Vector3d response = chart.response(i);
      const Eigen::VectorXd exact = deviationByAll(own, chart.solver, chart.reflectances, response);
      EXPECT_LE((chart.scene.deviation(response) - exact).norm(), 1e-11) << light << " " << i;
      const Eigen::VectorXd byAll = deviationByAll(seeds, chart.solver, many, response);
      EXPECT_GT(byAll.norm(), 1e-4);
      largest = std::max(largest, (scene.deviation(response) - byAll).norm() / byAll.norm());
    }
    std::printf("[ scene ] %s: seeds differ from all samples by up to %.4f of the deviation\n", light, largest);
    EXPECT_LE(largest, 0.05) << light;
  }
}

TEST(MeasuredSceneTest, OddAndDarkColoursHaveNoDeviation) {
  const ChartScene chart("D65");
  for (const Vector3d& colour :
       {Vector3d(kNan, 1, 1), Vector3d(1, kInfinity, 1), Vector3d(-kInfinity, 1, 1), Vector3d(kInfinity, -kInfinity, 1),
        Vector3d(0, 0, 0), Vector3d(-1, -1, -1), Vector3d(1, -2, 0.5), Vector3d(1, -1, 0)}) {
    EXPECT_TRUE(chart.scene.deviation(colour).isZero(0.0)) << colour.transpose();
    const MeasuredScene::Local local = chart.scene.local(colour);
    EXPECT_TRUE(local.value.isZero(0.0) && local.slope.isZero(0.0)) << colour.transpose();
    EXPECT_EQ(local.slope.rows(), kBands);
  }
}

TEST(MeasuredSceneTest, SamplesThatTheLightLeavesDarkAreLeftOut) {
  const ChartScene chart("D65");
  Eigen::MatrixXd withBlack(kBands, chart.reflectances.cols() + 1);
  withBlack << Eigen::VectorXd::Zero(kBands), chart.reflectances;
  const MeasuredScene with(chart.solver, withBlack, Eigen::VectorXd::Constant(withBlack.cols(), 0.2));
  for (const Vector3d& colour : colours(50)) {
    EXPECT_LE((with.deviation(colour) - chart.scene.deviation(colour)).norm(), 1e-13);
  }
  // A single sample, and none, are scenes too.
  const MeasuredScene one(chart.solver, chart.reflectances.leftCols(1), Eigen::VectorXd::Constant(1, 0.2));
  EXPECT_TRUE(one.deviation(Vector3d(0.3, 0.4, 0.2)).allFinite());
  const MeasuredScene none(chart.solver, Eigen::MatrixXd(kBands, 0), Eigen::VectorXd());
  EXPECT_TRUE(none.deviation(Vector3d(0.3, 0.4, 0.2)).isZero(0.0));
}

/// Mean CIEDE2000 of the model skins and of a chart, seen under the output light, against their own spectra.
struct SceneError {
  double skin = 0.0;
  double chart = 0.0;
};

SceneError errorOfScene(TransformSpec spec, ReferenceScene::Kind kind, double strength) {
  spec.adaptation = 1.0;
  spec.scene.kind = kind;
  spec.scene.strength = strength;
  spec.scene.virtualSkins = samplesOf("virtual skins");
  const SpectralTransform transform(spec, kBands);
  const Eigen::Matrix3d xyz = spec.space.xyzFromRgb();
  const Vector3d white = spec.space.whiteXyz();
  const auto mean = [&](const std::vector<spectral::DomainSamples>& samples) {
    double sum = 0.0;
    for (const spectral::DomainSamples& sample : samples) {
      const Vector3d result = transform.apply(inputRgb(spec, transform, sample));
      sum +=
          spectral::deltaE2000(spectral::lab(xyz * result, white), spectral::lab(xyz * outputRgb(spec, sample), white));
    }
    return sum / static_cast<double>(samples.size());
  };
  return {mean(spec.scene.skins), mean(samplesOf("tm30"))};
}

TEST(MeasuredSceneTest, SkinIsADialOfNatural) {
  const auto& pair = lightPairs()[3];
  const TransformSpec spec = naturalSpecOf(pair.first, pair.second);
  const SceneError smooth = errorOfScene(spec, ReferenceScene::Kind::Smooth, 1.0);
  const SceneError natural = errorOfScene(spec, ReferenceScene::Kind::Natural, 1.0);
  const SceneError none = errorOfScene(spec, ReferenceScene::Kind::Skin, 0.0);
  const SceneError half = errorOfScene(spec, ReferenceScene::Kind::Skin, 0.5);
  const SceneError full = errorOfScene(spec, ReferenceScene::Kind::Skin, 1.0);
  std::printf("[ scene ] %s: skin %.3f smooth, %.3f natural, %.3f half, %.3f skin; tm30 %.3f, %.3f, %.3f, %.3f\n",
              pairName(pair).c_str(), smooth.skin, natural.skin, half.skin, full.skin, smooth.chart, natural.chart,
              half.chart, full.chart);
  EXPECT_EQ(none.skin, natural.skin);
  EXPECT_EQ(none.chart, natural.chart);
  EXPECT_LT(half.skin, natural.skin);
  EXPECT_LT(full.skin, half.skin);
  EXPECT_LT(natural.skin, 0.5 * smooth.skin);
  EXPECT_LT(natural.chart, smooth.chart);
}

TEST(MeasuredSceneTest, NeutralsStayUnderEveryObserver) {
  for (const char* const observer : {"CIE 1931 2", "CIE 2015 10", "CIE 2006 LMS 2", "Nikon D5100"}) {
    TransformSpec spec = naturalSpecOf("D65", "HP1");
    spec.input.observer = testLibrary().observer(observer);
    spec.adaptation = 1.0;
    const SpectralTransform transform(spec, 41);
    for (const double grey : {0.01, 1.0, 30.0}) {
      EXPECT_LE((transform.apply(Vector3d::Constant(grey)) / grey - Vector3d::Ones()).norm(), 1e-10) << observer;
    }
  }
}

}  // namespace
}  // namespace metamer::sip
