// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/skin_priority.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cstdio>

#include "metamer/stage/chart_difference.h"
#include "metamer/stage/emitter_match.h"
#include "metamer/stage/emitter_model.h"
#include "metamer/stage/fixture.h"
#include "metamer/stage/match_outcome.h"
#include "metamer/stage/wall_spectra.h"
#include "spectral/fixture.h"

namespace metamer::stage {
namespace {

using spectral::errorOf;
using spectral::testLibrary;
using spectral::unitRandom;

/// A wall of model LEDs before a camera, with skins beside the chart.
struct Wall {
  WallSpectra spectra;
  WallCapture chart;
  WallOptions options;

  explicit Wall(const char* target, const char* camera = "Canon EOS 5D Mark II") {
    const char* const leds[] = {"led:628:14", "led:525:24", "led:460:16"};
    for (std::size_t k = 0; k < 3; ++k) {
      spectra.emitters[k] = emittersFrom(leds[k], testLibrary(), {}).front().spectrum.onDomain();
    }
    spectra.camera = testLibrary().observer(camera).onDomain();
    spectra.target = testLibrary().illuminant(target).onDomain();
    spectra.reflectances = testLibrary().reflectances("colorchecker").samples;
    chart = captureOf(spectra);
    spectra.reflectances = virtualSkins(testLibrary());
    options.skins = captureOf(spectra);
  }
};

MatchRequest requestOf(const char* method, const char* weights, double skinWeight) {
  MatchRequest request;
  request.method = method;
  request.weights = weights;
  request.skinWeight = skinWeight;
  return request;
}

MatchOutcome matched(const MatchRequest& request, const Fixture& fixture, const char* target) {
  return matchSpectra(request, fixture, testLibrary().illuminant(target), testLibrary().observer("CIE 1931 2"),
                      testLibrary().reflectances("colorchecker").samples, Eigen::Matrix3d::Identity(),
                      virtualSkins(testLibrary()));
}

TEST(SkinPriority, SkinsThatCountNothingChangeNothing) {
  const Wall wall("D65");
  const WallSolution without = solveWall(wall.chart);
  const WallSolution with = solveWall(wall.chart, wall.options);
  EXPECT_EQ(with.correctedFromCamera, without.correctedFromCamera);
  EXPECT_EQ(with.correctedSkins.cols(), kVirtualSkins);
  EXPECT_EQ(without.correctedSkins.cols(), 0);
}

TEST(SkinPriority, CountsAsPatchesOfThatWeight) {
  Wall wall("A");
  wall.options.skinWeight = 2.5;
  const WallSolution ours = solveWall(wall.chart, wall.options);
  // The same by one chart of all, each patch with its weight.
  WallCapture all = wall.chart;
  WallOptions weighted;
  const Eigen::Index patches = all.target.cols();
  const Eigen::Index count = patches + kVirtualSkins;
  for (std::size_t k = 0; k < 3; ++k) {
    all.charts[k].conservativeResize(Eigen::NoChange, count);
    all.charts[k].rightCols<kVirtualSkins>() = wall.options.skins->charts[k];
  }
  all.target.conservativeResize(Eigen::NoChange, count);
  all.target.rightCols<kVirtualSkins>() = wall.options.skins->target;
  all.patchNames.resize(static_cast<std::size_t>(count), "skin");
  weighted.patchWeights = Eigen::VectorXd::Constant(count, 2.5);
  weighted.patchWeights.head(patches).setOnes();
  // Sums of the same numbers in the same order.
  EXPECT_TRUE(ours.correctedFromCamera.isApprox(solveWall(all, weighted).correctedFromCamera, 1e-13));
  // And skin is nearer than without.
  Wall plain("A");
  const WallSolution none = solveWall(plain.chart, plain.options);
  const Eigen::Matrix3Xd& target = plain.options.skins->target;
  EXPECT_LT((ours.correctedSkins - target).norm(), 0.5 * (none.correctedSkins - target).norm());
}

/// Mean CIEDE2000 of a wall's chart and of 500 skins that none is solved with.
std::array<double, 2> chartAndOthers(Wall& wall, const char* target, double weight) {
  wall.options.skinWeight = weight;
  const WallSolution solution = solveWall(wall.chart, wall.options);

  WallSpectra others = wall.spectra;
  const auto& skins = testLibrary().reflectances("virtual skins").samples;
  others.reflectances.assign(skins.end() - 500, skins.end());
  WallOptions unsolved;
  unsolved.skins = captureOf(others);
  const WallSolution shown = solveWall(wall.chart, unsolved);

  // XYZ from the camera as the chart has it.
  others.camera = testLibrary().observer("CIE 1931 2").onDomain();
  others.target = testLibrary().illuminant(target).onDomain();
  others.reflectances = testLibrary().reflectances("colorchecker").samples;
  const Eigen::Matrix3Xd& seen = wall.chart.target;
  const Eigen::Matrix3d xyz = captureOf(others).target * seen.transpose() * (seen * seen.transpose()).inverse().eval();
  const auto meanOf = [&](const Eigen::Matrix3Xd& made, const Eigen::Matrix3Xd& wanted) {
    return summaryOf(chartDifferences(made, wanted, xyz, wall.chart.environmentWhite)).mean;
  };
  return {meanOf(solution.corrected, seen),
          meanOf(solution.correctedFromCamera * shown.predictedSkins, unsolved.skins->target)};
}

TEST(SkinPriority, BringsSkinNearUnderBroadLightsWithManyCameras) {
  for (const char* const camera : {"Canon EOS 5D Mark II", "Nikon D5100", "Canon 1D MkIII (fit)", "Canon 5D MkII (fit)",
                                   "Red Mysterium X (fit)"}) {
    for (const char* const target : {"A", "D65", "LED-B1", "LED-B3"}) {
      Wall wall(target, camera);
      const auto [bestChart, before] = chartAndOthers(wall, target, 0);
      const auto [chart, skin] = chartAndOthers(wall, target, kDefaultSkinWeight);
      std::printf("[ stage ] %s, %s: chart %.2f -> %.2f, skin %.2f -> %.2f\n", camera, target, bestChart, chart, before,
                  skin);
      EXPECT_LE(skin, 0.6) << camera << ", " << target;
      EXPECT_LE(chart, bestChart + 1.1) << camera << ", " << target;
    }
  }
}

TEST(SkinPriority, CondensedRowsHaveTheSameResidual) {
  std::mt19937 random(5);
  MatchSystem system{Eigen::MatrixXd(600, 5), Eigen::VectorXd(600)};
  for (double& value : system.matrix.reshaped()) {
    value = unitRandom(random);
  }
  for (double& value : system.target) {
    value = unitRandom(random);
  }
  const MatchSystem few = condensed(system);
  EXPECT_EQ(few.matrix.rows(), 6);
  for (int trial = 0; trial < 10; ++trial) {
    Eigen::VectorXd drives(5);
    for (double& value : drives) {
      value = unitRandom(random);
    }
    EXPECT_NEAR((few.matrix * drives - few.target).norm(), (system.matrix * drives - system.target).norm(), 1e-12);
  }
  EXPECT_EQ(condensed(few).matrix, few.matrix);
}

TEST(SkinPriority, MatchesSkinAtTheChartsCost) {
  const Fixture fixture = readFixture({"led:628:14", "led:525:24", "led:460:16", "led:590:12"}, testLibrary());
  for (const char* const weights : {"absolute", "relative", "perceptual"}) {
    const auto matchedWith = [&](double skinWeight) {
      return matched(requestOf("mrm", weights, skinWeight), fixture, "D65");
    };
    const MatchOutcome plain = matchedWith(0);
    const MatchOutcome skin = matchedWith(kDefaultSkinWeight);
    ASSERT_TRUE(plain.skins && skin.skins);
    EXPECT_EQ(plain.skins->count, kVirtualSkins);
    EXPECT_LT(skin.skins->differences.mean, plain.skins->differences.mean) << weights;
    EXPECT_GT(skin.skins->differences.deviation, 0);
    EXPECT_GE(skin.skins->differences.max, skin.skins->differences.mean);
    // The curve: the weight in use is the solution's own.
    for (const SkinTradeOff& point : skin.skins->tradeOffs) {
      if (point.weight == kDefaultSkinWeight) {
        EXPECT_EQ(point.skin.mean, skin.skins->differences.mean);
      }
    }
    EXPECT_EQ(skin.skins->tradeOffs.size(), kSkinTradeOffWeights.size());
  }
}

TEST(SkinPriority, IsReadAndRefused) {
  EXPECT_EQ(skinWeightFrom("skin"), kDefaultSkinWeight);
  EXPECT_EQ(skinWeightFrom("skin:0"), 0);
  EXPECT_EQ(skinWeightFrom("skin:2.5e1"), 25);
  for (const char* const text :
       {"", "skins", "skin:", "skin:-1", "skin:nan", "skin:1e7", "skin:4x", "chart:4", "skin 4"}) {
    EXPECT_NE(errorOf([&] { skinWeightFrom(text); }).find("--priority: priority"), std::string::npos) << text;
  }
  const Fixture fixture = readFixture({"led:628:14", "led:460:16"}, testLibrary());
  const auto message = errorOf([&] { matched(requestOf("mim", "absolute", 4), fixture, "A"); });
  EXPECT_NE(message.find("mrm alone"), std::string::npos) << message;
  EXPECT_EQ(skinTradeOffWeights(0.04).size(), kSkinTradeOffWeights.size());
  EXPECT_EQ(skinTradeOffWeights(3).size(), kSkinTradeOffWeights.size() + 1);
}

}  // namespace
}  // namespace metamer::stage
