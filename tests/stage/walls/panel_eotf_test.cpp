// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/panel_eotf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "spectral/fixture.h"

namespace metamer::stage {
namespace {

using spectral::errorOf;

/// SMPTE ST 2084, of its full 10,000 cd/m2.
double pq(double code) {
  const double root = std::pow(code, 32.0 / 2523);
  return std::pow(std::max(root - 3424.0 / 4096, 0.0) / (2413.0 / 128 - 2392.0 / 128 * root), 16384.0 / 2610);
}

/// Seventeen steps as a camera sees them, with relative noise.
DriveSeries seen(const std::function<double(double)>& light, double noise, std::mt19937& random) {
  std::normal_distribution<double> normal;
  DriveSeries series;
  series.rgb.resize(3, 17);
  for (int i = 0; i < 17; ++i) {
    series.drives.push_back(i * 4080.0);
    const Eigen::Vector3d clean = Eigen::Vector3d(0.8, 0.1, 0.05) * light(i / 16.0) + Eigen::Vector3d::Constant(0.002);
    for (int k = 0; k < 3; ++k) {
      series.rgb(k, i) = clean[k] * (1 + noise * normal(random));
    }
  }
  return series;
}

TEST(PanelEotf, PowersAreFoundThroughNoise) {
  std::mt19937 random(1);
  for (const double gamma : {1.0, 2.2, 2.4}) {
    // The second wall is dead below a twentieth of its drives.
    for (const double offset : {0.0, -0.05}) {
      const auto lit = [&](double d) { return std::pow(std::max((d + offset) / (1 + offset), 0.0), gamma); };
      for (int draw = 0; draw < 100; ++draw) {
        const PanelEotf eotf = fitEotf(seen(lit, 0.01, random));
        EXPECT_FALSE(eotf.isCurve);
        EXPECT_NEAR(eotf.gamma, gamma, 0.1);
        EXPECT_NEAR(eotf.offset, offset, 0.02);
        // 0.8 by 17 captures of 1 % noise, four deviations.
        EXPECT_NEAR(eotf.gain, 0.8, 0.02);
        for (double drive = 0.1; drive <= 1; drive += 0.01) {
          EXPECT_NEAR(eotf.lightOf(drive), lit(drive), 0.01) << gamma << " at " << drive;
          EXPECT_NEAR(eotf.driveFor(eotf.lightOf(drive)), drive, 1e-9);
        }
      }
    }
  }
}

TEST(PanelEotf, OtherCurvesAreFollowed) {
  std::mt19937 random(2);
  // The whole of PQ, and a wall that stops at 1,000 cd/m2.
  for (const double top : {1.0, 0.7518}) {
    const auto light = [&](double d) { return std::min(pq(d) / pq(top), 1.0); };
    for (int draw = 0; draw < 100; ++draw) {
      const PanelEotf eotf = fitEotf(seen(light, 0.01, random));
      EXPECT_TRUE(eotf.isCurve);
      EXPECT_LT(eotf.residual, 0.02);
      double worst = 0;
      for (double wanted = 0.01; wanted < 0.95; wanted += 0.01) {
        // What the wall shows where this curve is undone, over what was wanted: noise of two steps, four deviations,
        // and 1 % of interpolation.
        worst = std::max(worst, std::abs(light(eotf.driveFor(wanted)) / wanted - 1));
      }
      EXPECT_LT(worst, 0.06);
    }
  }
}

TEST(PanelEotf, WithoutNoiseItIsExact) {
  std::mt19937 random(3);
  const PanelEotf eotf = fitEotf(seen([](double d) { return std::pow(d, 2.4); }, 0, random));
  EXPECT_NEAR(eotf.gamma, 2.4, 1e-9);
  EXPECT_NEAR(eotf.offset, 0, 1e-12);
  EXPECT_NEAR(eotf.gain, 0.8, 1e-9);
  EXPECT_NEAR(eotf.black, 0.002, 1e-12);
  EXPECT_LT(eotf.residual, 1e-9);
}

TEST(PanelEotf, RefusesWhatIsNoRamp) {
  std::mt19937 random(4);
  DriveSeries series = seen([](double d) { return d; }, 0, random);
  series.drives.front() = 1;
  EXPECT_NE(errorOf([&] { fitEotf(series); }).find("begin at 0"), std::string::npos);
  DriveSeries few{{0, 1, 2, 3}, Eigen::Matrix3Xd::Identity(3, 4)};
  few.rgb << 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3;
  EXPECT_NE(errorOf([&] { fitEotf(few); }).find("five"), std::string::npos);
  EXPECT_NE(errorOf([] { parseDriveSeries("patch,R,G,B\nred,1,1,1\n", "r.csv"); }).find("r.csv"), std::string::npos);
  EXPECT_NE(errorOf([] { parseDriveSeries("patch,R,G,B\n0,1,,1\n", "r.csv"); }).find("missing"), std::string::npos);
}

}  // namespace
}  // namespace metamer::stage
