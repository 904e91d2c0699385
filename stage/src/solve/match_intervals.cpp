// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Dense>

#include "metamer/stage/chart_difference.h"
#include "metamer/stage/match_limits.h"
#include "solve/draws.h"

namespace metamer::stage {
MatchIntervals matchIntervals(const std::vector<ChartTable>& emitterCharts, const ChartTable& target,
                              const MatchOfCharts& match, const IntervalOptions& options) {
  requireDraws(options);
  const MatchOutcome centre = match(emitterCharts, target);
  std::vector<Eigen::VectorXd> drives(static_cast<std::size_t>(options.samples));
  std::vector<double> means(drives.size());
  runDraws(options, [&](int i) {
    Noise noise(options, static_cast<std::uint64_t>(i));
    const auto noisy = [&](ChartTable table) {
      noise.add(table.rgb);
      return table;
    };
    std::vector<ChartTable> charts;
    for (const ChartTable& chart : emitterCharts) {
      charts.push_back(noisy(chart));
    }
    const MatchOutcome drawn = match(std::move(charts), noisy(target));
    means[static_cast<std::size_t>(i)] = summaryOf(differencesOf(drawn)).mean;
    drives[static_cast<std::size_t>(i)] = drawn.match.drives;
  });
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
