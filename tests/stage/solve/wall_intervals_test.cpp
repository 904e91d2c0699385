// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/wall_intervals.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <thread>

#include "captured_wall.h"
#include "metamer/stage/chart_difference.h"
#include "spectral/fixture.h"

namespace metamer::stage {
namespace {

using Eigen::Matrix3d;

IntervalOptions optionsOf(const WallCapture& capture, double noise, int samples) {
  IntervalOptions options;
  options.noise.relative = noise;
  options.samples = samples;
  options.xyzFromCamera = spectral::testLibrary().colourSpace("ACEScg").linear.xyzFromRgb();
  options.whiteRgb = capture.target.col(18);
  options.exposurePatch = 18;
  return options;
}

/// Shares of captures whose intervals hold what a capture without noise gives.
struct Coverage {
  double q = 0;
  double n = 0;
  double drive = 0;
  double mean = 0;  ///< CIEDE2000 after Q
  double max = 0;
  double width = 0;  ///< half that of Q, over Q's largest number
};

template <typename Value>
double inside(const Interval<Value>& interval, const Value& truth) {
  return ((interval.low.array() <= truth.array()) && (truth.array() <= interval.high.array()))
      .template cast<double>()
      .mean();
}

double inside(const Interval<double>& interval, double truth) {
  return interval.low <= truth && truth <= interval.high ? 1 : 0;
}

Coverage coverageOf(const WallCapture& truth, double noise, bool estimates, int captures, int samples) {
  const WallSolution exact = solveWall(truth);
  const IntervalOptions there = optionsOf(truth, noise, samples);
  const auto differences =
      summaryOf(chartDifferences(exact.corrected, truth.target, there.xyzFromCamera, there.whiteRgb));
  Coverage sum;
  for (int i = 0; i < captures; ++i) {
    const WallCapture seen = withNoise(truth, noise, 7000u + static_cast<std::uint64_t>(i));
    const double known =
        estimates ? estimatedNoise(*expectedChart(seen), {seen.charts[0], seen.charts[1], seen.charts[2], seen.target})
                  : noise;
    const WallIntervals found = wallIntervals(seen, {}, optionsOf(seen, known, samples));
    sum.q += inside(found.correctedFromCamera, exact.correctedFromCamera);
    sum.n += inside(found.frustumFromContent, exact.frustumFromContent);
    sum.drive += inside(found.environmentDrive, exact.environmentDrive);
    sum.mean += inside(found.meanAfter, differences.mean);
    sum.max += inside(found.maxAfter, differences.max);
    sum.width += (found.correctedFromCamera.high - found.correctedFromCamera.low).maxCoeff() / 2 /
                 exact.correctedFromCamera.cwiseAbs().maxCoeff();
  }
  for (double* one : {&sum.q, &sum.n, &sum.drive, &sum.mean, &sum.max, &sum.width}) {
    *one /= captures;
  }
  return sum;
}

/// Of captures with noise, the intervals hold the solution without noise as often as they say: also where noise biases
/// it, under sodium light.
TEST(WallIntervals, CoverTheTruth) {
  struct Case {
    const char* camera;
    const char* target;
    double noise;
    bool estimates;
    bool isLong;
  };
  const bool isLong = std::getenv("METAMER_LONG") != nullptr;
  const int captures = isLong ? 300 : 60;
  const int samples = isLong ? 500 : 200;
  // 95 % over so many captures, whose nine numbers hang together: two standard errors of a share of 0.95.
  const double margin = isLong ? 0.03 : 0.06;
  const char* canon = "Canon EOS 5D Mark II";
  const char* nikon = "Nikon D5100";
  for (const auto& one : {Case{canon, "A", 0.01, false, false}, Case{nikon, "HP1", 0.01, false, false},
                          Case{canon, "A", 0.01, true, true}, Case{canon, "FL2", 0.01, false, true},
                          Case{canon, "FL2", 0.01, true, true}, Case{canon, "D65", 0.01, false, true},
                          Case{canon, "D65", 0.01, true, true}, Case{canon, "HP1", 0.01, false, true},
                          Case{canon, "D65", 0.03, false, true}, Case{nikon, "FL2", 0.03, false, true}}) {
    if (one.isLong && !isLong) {
      continue;
    }
    const Coverage held = coverageOf(capturedWall(one.camera, one.target), one.noise, one.estimates, captures, samples);
    std::printf(
        "%s, %s, noise of %.0f %% %s: of %d captures the 95 %% intervals cover %.1f %% of Q, %.1f %% of N, %.1f %% of "
        "the drives, %.1f %% and %.1f %% of the mean and largest CIEDE2000; half a width of Q is %.1f %%\n",
        one.camera, one.target, 100 * one.noise, one.estimates ? "estimated" : "stated", captures, 100 * held.q,
        100 * held.n, 100 * held.drive, 100 * held.mean, 100 * held.max, 100 * held.width);
    // The estimate of one capture is itself uncertain by a tenth.
    const double low = 0.95 - margin - (one.estimates ? 0.02 : 0);
    for (const double share : {held.q, held.n, held.drive}) {
      EXPECT_GE(share, low);
      EXPECT_LE(share, one.estimates ? 1 : 0.95 + margin);
    }
    // One number a capture; those of lengths are wider than they need where noise is most of the length.
    EXPECT_GE(held.mean, low - 0.02);
    EXPECT_GE(held.max, low - 0.02);
  }
}

TEST(WallIntervals, EndsOfLengthsAreLowered) {
  // A length of 3 seen as 5 by noise of 4; drawn once more sqrt(41) on average.
  const Interval<double> ends = loweredEnds({std::sqrt(41 - 8), std::sqrt(41 + 8)}, 5);
  EXPECT_NEAR(ends.low, std::sqrt(9 - 8), 0.2);
  EXPECT_NEAR(ends.high, std::sqrt(9 + 8), 0.2);
  EXPECT_EQ(loweredEnds({1, 9}, 1).low, 0);
}

TEST(WallIntervals, AreTheSameForAnyThreads) {
  const WallCapture capture = withNoise(capturedWall("Canon EOS 5D Mark II", "FL2"), 0.01, 1);
  IntervalOptions options = optionsOf(capture, 0.01, 64);
  const WallIntervals one = wallIntervals(capture, {}, options);
  options.runAll = [](int count, const std::function<void(int)>& body) {
    std::thread odd([&] {
      for (int i = 1; i < count; i += 2) {
        body(i);
      }
    });
    for (int i = (count - 1) / 2 * 2; i >= 0; i -= 2) {
      body(i);
    }
    odd.join();
  };
  const WallIntervals two = wallIntervals(capture, {}, options);
  EXPECT_EQ(one.correctedFromCamera.low, two.correctedFromCamera.low);
  EXPECT_EQ(one.frustumFromContent.high, two.frustumFromContent.high);
  EXPECT_EQ(one.meanAfter.high, two.meanAfter.high);
  options.seed = 2;
  EXPECT_NE(wallIntervals(capture, {}, options).correctedFromCamera.low, one.correctedFromCamera.low);
}

TEST(WallIntervals, ShrinkWithTheNoise) {
  const WallCapture capture = capturedWall("Canon EOS 5D Mark II", "A");
  const WallIntervals none = wallIntervals(capture, {}, optionsOf(capture, 0, 20));
  const Matrix3d q = solveWall(capture).correctedFromCamera;
  EXPECT_EQ(none.correctedFromCamera.low, q);
  EXPECT_EQ(none.correctedFromCamera.high, q);
  const auto width = [&](double noise) {
    const auto found = wallIntervals(capture, {}, optionsOf(capture, noise, 400)).correctedFromCamera;
    return (found.high - found.low).norm();
  };
  // Small noise goes through a linear map.
  EXPECT_NEAR(width(0.004) / width(0.002), 2, 0.05);
}

/// Where noise decides, N's bound is lowered; where Q is well known it is not.
TEST(WallIntervals, ChooseTheBound) {
  const WallCapture sodium = capturedWall("Canon EOS 5D Mark II", "HP1");
  const double condition = solveWall(sodium).correctionCondition;
  EXPECT_GT(condition, 20);
  IntervalOptions options = optionsOf(sodium, 1e-5, 100);
  options.choosesBound = true;
  const WallIntervals known = wallIntervals(sodium, {}, options);
  EXPECT_GE(known.largestCondition, condition);
  options.noise.relative = 0.05;
  const WallIntervals noisy = wallIntervals(sodium, {}, options);
  EXPECT_LT(noisy.largestCondition, condition);
  options.choosesBound = false;
  EXPECT_LT(noisy.frustumError, wallIntervals(sodium, {}, options).frustumError);
}

TEST(WallIntervals, NumbersAreNormal) {
  double sum = 0;
  double squares = 0;
  double products = 0;
  constexpr int kCount = 20'000;
  for (int i = 0; i < kCount; ++i) {
    const double a = normalNumber(3, static_cast<std::uint64_t>(i), 5);
    sum += a;
    squares += a * a;
    products += a * normalNumber(3, static_cast<std::uint64_t>(i), 6);
  }
  // Four standard errors.
  EXPECT_NEAR(sum / kCount, 0, 4 / std::sqrt(kCount));
  EXPECT_NEAR(squares / kCount, 1, 4 * std::sqrt(2.0 / kCount));
  EXPECT_NEAR(products / kCount, 0, 4 / std::sqrt(kCount));
}

TEST(WallIntervals, RefusesOptionsOutOfRange) {
  const WallCapture capture = capturedWall("Canon EOS 5D Mark II", "A");
  const auto with = [&](const auto& change) {
    IntervalOptions options = optionsOf(capture, 0.01, 20);
    change(options);
    return spectral::errorOf([&] { wallIntervals(capture, {}, options); });
  };
  EXPECT_NE(with([](auto& o) { o.noise.relative = 1.1; }).find("noise"), std::string::npos);
  EXPECT_NE(with([](auto& o) { o.noise.floor = -1; }).find("noise floor"), std::string::npos);
  EXPECT_NE(with([](auto& o) { o.samples = 19; }).find("samples"), std::string::npos);
  EXPECT_NE(with([](auto& o) { o.whitePatch = 24; }).find("white patch"), std::string::npos);
  EXPECT_NE(with([](auto& o) { o.exposurePatch = -2; }).find("exposure patch"), std::string::npos);
  EXPECT_NE(with([](auto& o) { o.whiteReflectance = 0; }).find("white reflectance"), std::string::npos);
}

}  // namespace
}  // namespace metamer::stage
