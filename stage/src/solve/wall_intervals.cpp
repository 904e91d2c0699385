// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/wall_intervals.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "metamer/spectral/argument_checks.h"
#include "metamer/stage/chart_difference.h"
#include "solve/attenuation.h"
#include "solve/draws.h"

namespace metamer::stage {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr double kTail = 0.025;
/// A smaller bound of N is taken where it costs no more than this.
constexpr double kAsGood = 1.05;
/// Q of a lower condition number needs no bound.
constexpr double kNotableCondition = 10;

std::uint64_t mixed(std::uint64_t value) {
  value += 0x9E3779B97F4A7C15u;
  value = (value ^ (value >> 30u)) * 0xBF58476D1CE4E5B9u;
  value = (value ^ (value >> 27u)) * 0x94D049BB133111EBu;
  return value ^ (value >> 31u);
}

/// One draw's solution.
struct Sample {
  Matrix3d m, q, n;
  Matrix3d freedQ;  ///< without what the noise takes from it
  Vector3d drive;
  double meanBefore = 0;
  double meanAfter = 0;
  double maxAfter = 0;
};

/// @param times  how often the noise lies on the capture
Sample solved(const WallCapture& capture, const WallOptions& walls, const IntervalOptions& options, double times) {
  const WallSolution solution = solveWall(capture, walls);
  Sample sample;
  sample.m = solution.wallFromContent;
  sample.q = solution.correctedFromCamera;
  sample.freedQ = withoutAttenuation(capture, walls, solution, options.noise, times);
  sample.n = sample.m * boundedInverse(sample.freedQ, walls.largestCondition);
  sample.drive = solution.environmentDrive;
  double exposure = 1;
  if (options.exposurePatch >= 0 && solution.predicted(1, options.exposurePatch) > 0 &&
      capture.target(1, options.exposurePatch) > 0) {
    exposure = capture.target(1, options.exposurePatch) / solution.predicted(1, options.exposurePatch);
  }
  sample.meanBefore = summaryOf(chartDifferences(exposure * solution.predicted, capture.target, options.xyzFromCamera,
                                                 options.whiteRgb))
                          .mean;
  const auto after =
      summaryOf(chartDifferences(solution.corrected, capture.target, options.xyzFromCamera, options.whiteRgb));
  sample.meanAfter = after.mean;
  sample.maxAfter = after.max;
  return sample;
}

template <typename Value, typename Take>
Interval<Value> ends(const std::vector<Sample>& samples, const Take& take) {
  Interval<Value> result;
  std::vector<double> values(samples.size());
  for (Eigen::Index i = 0; i < result.low.size(); ++i) {
    for (std::size_t s = 0; s < samples.size(); ++s) {
      values[s] = take(samples[s]).reshaped()[i];
    }
    const Interval<double> one = endsOf(values);
    result.low.reshaped()[i] = one.low;
    result.high.reshaped()[i] = one.high;
  }
  return result;
}

template <typename Take>
std::vector<double> taken(const std::vector<Sample>& samples, const Take& take) {
  std::vector<double> values(samples.size());
  std::transform(samples.begin(), samples.end(), values.begin(), take);
  return values;
}

template <typename Take>
Interval<double> turnedEnds(const std::vector<Sample>& samples, const Sample& centre, const Take& take) {
  const Interval<double> found = endsOf(taken(samples, take));
  return {std::max(0.0, 2 * take(centre) - found.high), std::max(0.0, 2 * take(centre) - found.low)};
}

void check(const IntervalOptions& options, Eigen::Index patches) {
  requireDraws(options);
  spectral::requireWithin("white patch", options.whitePatch, -1, static_cast<double>(patches) - 1);
  spectral::requireWithin("exposure patch", options.exposurePatch, -1, static_cast<double>(patches) - 1);
  spectral::requireAbove("white reflectance", options.whiteReflectance, 0);
}

}  // namespace

Interval<double> loweredEnds(std::vector<double> values, double centre) {
  double squares = 0;
  for (const double value : values) {
    squares += value * value / static_cast<double>(values.size());
  }
  const double twice = 2 * (squares - centre * centre);
  const Interval<double> found = endsOf(std::move(values));
  const auto lowered = [&](double end) { return std::sqrt(std::max(0.0, end * end - twice)); };
  return {lowered(found.low), lowered(found.high)};
}

Interval<double> endsOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    const double place = share * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
  };
  return {at(kTail), at(1 - kTail)};
}

double normalNumber(std::uint64_t seed, std::uint64_t sample, std::uint64_t place) {
  const std::uint64_t key = mixed(mixed(mixed(seed) ^ sample) ^ place);
  constexpr double kUnit = 1.0 / 9007199254740992.0;  // 2^-53
  const double u = (static_cast<double>(key >> 11u) + 0.5) * kUnit;
  const double v = static_cast<double>(mixed(key) >> 11u) * kUnit;
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * M_PI * v);
}

WallCapture noisyCapture(const WallCapture& capture, const IntervalOptions& options, std::uint64_t sample) {
  WallCapture result = capture;
  Noise noise(options, sample);
  noise.add(result.cameraFromWall);
  for (Matrix3Xd& chart : result.charts) {
    noise.add(chart);
  }
  noise.add(result.target);
  if (options.whitePatch >= 0) {
    result.environmentWhite = result.target.col(options.whitePatch) / options.whiteReflectance;
  } else {
    noise.add(result.environmentWhite);
  }
  return result;
}

WallIntervals wallIntervals(const WallCapture& capture, const WallOptions& walls, const IntervalOptions& options) {
  check(options, capture.target.cols());
  const WallSolution nominal = solveWall(capture, walls);
  const Sample centre = solved(capture, walls, options, 1);
  std::vector<Sample> samples(static_cast<std::size_t>(options.samples));
  runDraws(options, [&](int i) {
    const auto sample = static_cast<std::uint64_t>(i);
    samples[static_cast<std::size_t>(i)] = solved(noisyCapture(capture, options, sample), walls, options, 2);
  });

  WallIntervals result;
  result.samples = options.samples;
  const Matrix3d there = nominal.correctedFromCamera * capture.cameraFromWall;
  const auto error = [&](double limit) {
    double sum = 0;
    for (const Sample& sample : samples) {
      const Matrix3d n = sample.m * boundedInverse(sample.q, limit);
      const Matrix3d away = there * n - Matrix3d::Identity();
      sum += std::pow(Eigen::JacobiSVD<Matrix3d>(away).singularValues()[0], 2);
    }
    return std::sqrt(sum / static_cast<double>(samples.size()));
  };
  result.largestCondition = walls.largestCondition;
  result.frustumError = error(walls.largestCondition);
  if (options.choosesBound && nominal.correctionCondition > kNotableCondition) {
    std::vector<std::pair<double, double>> tried;
    double least = result.frustumError;
    for (const double limit : kTradeOffLimits) {
      if (limit < walls.largestCondition) {
        tried.emplace_back(limit, error(limit));
        least = std::min(least, tried.back().second);
      }
    }
    for (const auto& [limit, found] : tried) {
      if (found <= kAsGood * least) {
        result.largestCondition = limit;
        result.frustumError = found;
        result.boundIsChosen = true;
        break;
      }
    }
    for (Sample& sample : samples) {
      sample.n = sample.m * boundedInverse(sample.freedQ, result.largestCondition);
    }
  }
  result.wallFromContent = ends<Matrix3d>(samples, [](const Sample& s) -> const Matrix3d& { return s.m; });
  result.correctedFromCamera = ends<Matrix3d>(samples, [](const Sample& s) -> const Matrix3d& { return s.freedQ; });
  result.frustumFromContent = ends<Matrix3d>(samples, [](const Sample& s) -> const Matrix3d& { return s.n; });
  result.environmentDrive = ends<Vector3d>(samples, [](const Sample& s) -> const Vector3d& { return s.drive; });
  result.meanBefore = turnedEnds(samples, centre, [](const Sample& s) { return s.meanBefore; });
  result.meanAfter = loweredEnds(taken(samples, [](const Sample& s) { return s.meanAfter; }), centre.meanAfter);
  result.maxAfter = loweredEnds(taken(samples, [](const Sample& s) { return s.maxAfter; }), centre.maxAfter);
  return result;
}

}  // namespace metamer::stage
