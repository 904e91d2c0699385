// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Dense>
#include <limits>

#include "metamer/spectral/argument_checks.h"
#include "metamer/stage/chart_difference.h"
#include "metamer/stage/match_limits.h"

namespace metamer::stage {
namespace {

constexpr int kFewestSamples = 20;
constexpr int kMostSamples = 100'000;

}  // namespace

MatchIntervals matchIntervals(const std::vector<ChartTable>& emitterCharts, const ChartTable& target,
                              const MatchOfCharts& match, const IntervalOptions& options) {
  spectral::requireWithin("noise", options.noise.relative, 0, 1);
  spectral::requireWithin("noise floor", options.noise.floor, 0, std::numeric_limits<double>::max());
  spectral::requireWithin("samples", options.samples, kFewestSamples, kMostSamples);
  const MatchOutcome centre = match(emitterCharts, target);
  std::vector<Eigen::VectorXd> drives(static_cast<std::size_t>(options.samples));
  std::vector<double> means(drives.size());
  const auto body = [&](int i) {
    const auto sample = static_cast<std::uint64_t>(i);
    std::uint64_t place = 0;
    const auto noisy = [&](ChartTable table) {
      for (double& value : table.rgb.reshaped()) {
        value += std::hypot(options.noise.relative * value, options.noise.floor) *
                 normalNumber(options.seed, sample, place++);
      }
      return table;
    };
    std::vector<ChartTable> charts;
    for (const ChartTable& chart : emitterCharts) {
      charts.push_back(noisy(chart));
    }
    const MatchOutcome drawn = match(std::move(charts), noisy(target));
    means[static_cast<std::size_t>(i)] = summaryOf(differencesOf(drawn)).mean;
    drives[static_cast<std::size_t>(i)] = drawn.match.drives;
  };
  if (options.runAll) {
    options.runAll(options.samples, body);
  } else {
    for (int i = 0; i < options.samples; ++i) {
      body(i);
    }
  }
  MatchIntervals result;
  result.samples = options.samples;
  result.noise = options.noise;
  const Eigen::Index emitters = centre.match.drives.size();
  result.drives = {Eigen::VectorXd(emitters), Eigen::VectorXd(emitters)};
  std::vector<double> values(drives.size());
  for (Eigen::Index k = 0; k < emitters; ++k) {
    for (std::size_t s = 0; s < drives.size(); ++s) {
      values[s] = drives[s][k];
    }
    const Interval<double> ends = endsOf(values);
    result.drives.low[k] = ends.low;
    result.drives.high[k] = ends.high;
  }
  result.mean = loweredEnds(std::move(means), summaryOf(differencesOf(centre)).mean);
  return result;
}

}  // namespace metamer::stage
