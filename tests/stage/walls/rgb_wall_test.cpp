// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/rgb_wall.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "metamer/stage/stage_geometry.h"
#include "spectral/fixture.h"

namespace metamer::stage {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using spectral::errorOf;
using spectral::unitRandom;

/// A wall whose light a chart of `patches` sends back by three numbers a patch, and a target that Q makes exactly.
WallCapture capture(int patches, const Matrix3d& correction = Matrix3d::Identity()) {
  std::mt19937 random(3);
  WallCapture wall;
  wall.cameraFromWall << 0.82, 0.31, 0.02, 0.09, 0.90, 0.14, 0.01, 0.12, 0.88;
  wall.beta = 4.0;
  wall.environmentWhite = Vector3d(1.1, 1.0, 0.8);
  const Vector3d drive = wall.cameraFromWall.inverse() * wall.environmentWhite;
  Matrix3Xd predicted = Matrix3Xd::Zero(3, patches);
  for (std::size_t k = 0; k < 3; ++k) {
    wall.charts[k].resize(3, patches);
    for (double& value : wall.charts[k].reshaped()) {
      value = 0.01 + 0.2 * unitRandom(random);
    }
    predicted += wall.beta * drive[static_cast<Eigen::Index>(k)] * wall.charts[k];
  }
  wall.target = correction * predicted;
  for (int i = 0; i < patches; ++i) {
    wall.patchNames.push_back("p" + std::to_string(i));
  }
  return wall;
}

TEST(RgbWall, FindsTheCorrectionThatWasPutIn) {
  Matrix3d correction;
  correction << 0.9, 0.2, -0.1, 0.1, 0.85, 0.05, -0.05, 0.15, 0.9;
  WallCapture wall = capture(9, correction);
  wall.blackLevel = Vector3d(0.01, 0.02, 0.03);
  const WallSolution solution = solveWall(wall);
  // 1e-12: a well-conditioned solve of 9 patches in double precision.
  EXPECT_TRUE(solution.correctedFromCamera.isApprox(correction, 1e-12));
  EXPECT_TRUE(solution.wallFromContent.isApprox(wall.cameraFromWall.inverse(), 1e-14));
  EXPECT_TRUE(solution.frustumFromContent.isApprox(wall.cameraFromWall.inverse() * correction.inverse(), 1e-12));
  EXPECT_TRUE(solution.frustumOffset.isApprox(-wall.cameraFromWall.inverse() * wall.blackLevel, 1e-14));
  EXPECT_FALSE(solution.bounded);
  EXPECT_EQ(solution.chartRank, 3);
}

TEST(RgbWall, InFrustumColoursStay) {
  Matrix3d correction;
  correction << 0.7, 0.3, 0.0, 0.2, 0.7, 0.1, 0.0, 0.2, 0.8;
  WallCapture wall = capture(24, correction);
  wall.blackLevel = Vector3d(0.02, 0.01, 0.03);
  const WallSolution solution = solveWall(wall);
  const Vector3d content(0.4, 0.3, 0.2);
  const Vector3d drive = solution.frustumFromContent * content + solution.frustumOffset;
  const Vector3d recorded = wall.cameraFromWall * drive + wall.blackLevel;
  EXPECT_TRUE((solution.correctedFromCamera * recorded).isApprox(content, 1e-12));
}

TEST(RgbWall, HoldsWhite) {
  WallCapture wall = capture(12);
  std::mt19937 random(5);
  for (double& value : wall.target.reshaped()) {
    value *= 1 + 0.2 * (unitRandom(random) - 0.5);
  }
  WallOptions options;
  options.heldPatch = 4;
  const WallSolution held = solveWall(wall, options);
  EXPECT_TRUE(held.corrected.col(4).isApprox(wall.target.col(4), 1e-12));
  const WallSolution free = solveWall(wall);
  EXPECT_GT((held.corrected - wall.target).norm(), (free.corrected - wall.target).norm());
  // No matrix that holds white does better: small steps that keep Q p only make it worse.
  for (int i = 0; i < 100; ++i) {
    // In braces: one after another.
    Vector3d across{unitRandom(random) - 0.5, unitRandom(random) - 0.5, unitRandom(random) - 0.5};
    const Vector3d white = held.predicted.col(4).normalized();
    across -= across.dot(white) * white;
    Matrix3d step = Matrix3d::Zero();
    step.row(i % 3) = 1e-3 * across.transpose();
    EXPECT_GE(((held.correctedFromCamera + step) * held.predicted - wall.target).norm(),
              (held.corrected - wall.target).norm());
  }
}

TEST(RgbWall, RankOneTargetsBoundN) {
  WallCapture wall = capture(24);
  const Eigen::RowVectorXd brightness = wall.target.row(1);
  wall.target = Vector3d(1.0, 0.6, 0.05) * brightness;
  const WallSolution solution = solveWall(wall);
  EXPECT_TRUE(solution.bounded);
  EXPECT_TRUE(solution.frustumFromContent.allFinite());
  EXPECT_TRUE(solution.corrected.isApprox(wall.target, 1e-9));
  const double largest = Eigen::JacobiSVD<Matrix3d>(solution.correctedFromCamera).singularValues()[0];
  const Matrix3d inverse = wall.cameraFromWall * solution.frustumFromContent;
  EXPECT_NEAR(Eigen::JacobiSVD<Matrix3d>(inverse).singularValues()[0], kDefaultLargestCondition / largest, 1e-6);
  ASSERT_FALSE(solution.tradeOffs.empty());
  for (std::size_t i = 1; i < solution.tradeOffs.size(); ++i) {
    EXPECT_GT(solution.tradeOffs[i].gain, solution.tradeOffs[i - 1].gain);
    EXPECT_LE(solution.tradeOffs[i].frustumError, solution.tradeOffs[i - 1].frustumError + 1e-12);
  }
}

TEST(RgbWall, TooFewPatchesStayNearTheIdentity) {
  const WallCapture wall = capture(1, 0.5 * Matrix3d::Identity());
  const WallSolution solution = solveWall(wall);
  EXPECT_EQ(solution.chartRank, 1);
  EXPECT_TRUE(solution.corrected.isApprox(wall.target, 1e-12));
  // Across the one colour that is known, nothing is done.
  const Vector3d other = solution.predicted.col(0).unitOrthogonal();
  EXPECT_TRUE((solution.correctedFromCamera * other).isApprox(other, 1e-12));
}

TEST(RgbWall, RefusesWhatCannotBeSolved) {
  const auto errorWith = [](auto change) {
    WallCapture wall = capture(6);
    change(wall);
    return errorOf([&] { solveWall(wall); });
  };
  EXPECT_NE(errorWith([](WallCapture& w) { w.cameraFromWall.col(1).setZero(); }).find("primaries.green"),
            std::string::npos);
  EXPECT_NE(errorWith([](WallCapture& w) { w.cameraFromWall.col(2) = w.cameraFromWall.col(0); }).find("collinear"),
            std::string::npos);
  EXPECT_NE(errorWith([](WallCapture& w) { w.charts[0].setZero(); }).find("charts.red"), std::string::npos);
  EXPECT_NE(errorWith([](WallCapture& w) { w.environmentWhite.setZero(); }).find("environment.white"),
            std::string::npos);
  EXPECT_NE(errorWith([](WallCapture& w) { w.blackLevel.setConstant(2); }).find("above the signal"), std::string::npos);
  EXPECT_NE(errorWith([](WallCapture& w) { w.target.setZero(); }).find("charts.target"), std::string::npos);
}

TEST(StageGeometry, FormFactor) {
  // The figures that the course notes' authors print: 0.2394 to four digits is cut, not rounded; 4.18 is rounded.
  EXPECT_NEAR(rectangleFormFactor(1, 1, 1), 0.23945, 2e-5);
  EXPECT_NEAR(calibrationSquareBeta(1, 1, 1), 4.18, 0.005);
  // An endless wall fills the hemisphere, and a small far one is area over pi d^2.
  EXPECT_NEAR(rectangleFormFactor(1e6, 1e6, 1), 1, 1e-5);
  EXPECT_NEAR(rectangleFormFactor(0.01, 0.02, 1), 0.0002 / 3.14159265358979, 1e-8);
  // The cosine-weighted solid angle, summed over the rectangle.
  double sum = 0;
  constexpr int kSteps = 400;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double x = 2.0 * ((i + 0.5) / kSteps - 0.5);
      const double y = 0.7 * ((j + 0.5) / kSteps - 0.5);
      const double squared = x * x + y * y + 1.5 * 1.5;
      sum += 2.0 * 0.7 / (kSteps * kSteps) * 1.5 * 1.5 / (3.14159265358979 * squared * squared);
    }
  }
  EXPECT_NEAR(rectangleFormFactor(2.0, 0.7, 1.5), sum, 1e-6);
}

TEST(StageGeometry, LatLong) {
  const LatLong layout{64, 32};
  double whole = 0;
  Vector3d mean = Vector3d::Zero();
  for (int row = 0; row < layout.height; ++row) {
    for (int column = 0; column < layout.width; ++column) {
      whole += layout.solidAngle(row);
      mean += layout.solidAngle(row) * layout.direction(column, row);
      EXPECT_NEAR(layout.direction(column, row).norm(), 1, 1e-12);
    }
  }
  EXPECT_NEAR(whole, 4 * 3.14159265358979, 1e-10);
  EXPECT_NEAR(mean.norm(), 0, 1e-10);
  EXPECT_GT(layout.direction(0, 0).y(), 0.99);    // up
  EXPECT_GT(layout.direction(32, 16).z(), 0.99);  // the middle
  EXPECT_GT(layout.direction(16, 16).x(), 0.99);  // left of it
}

}  // namespace
}  // namespace metamer::stage
