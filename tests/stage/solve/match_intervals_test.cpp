// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "metamer/stage/chart_difference.h"
#include "metamer/stage/emitter_model.h"
#include "metamer/stage/match_limits.h"
#include "spectral/fixture.h"

namespace metamer::stage {
namespace {

struct Charts {
  std::vector<ChartTable> emitters;
  ChartTable target;
};

/// What a camera sees of the chart under red, green, blue and white LEDs, and under a light.
Charts chartsUnder(const std::string& target) {
  const auto& library = spectral::testLibrary();
  const auto camera = library.observer("Canon EOS 5D Mark II").onDomain();
  const auto reflectances = library.reflectances("colorchecker").samples;
  const auto seen = [&](const spectral::DomainSamples& light, const char* name) {
    ChartTable table{name, {}, Eigen::Matrix3Xd(3, static_cast<Eigen::Index>(reflectances.size()))};
    for (std::size_t i = 0; i < reflectances.size(); ++i) {
      table.names.push_back(reflectances[i].name());
      table.rgb.col(static_cast<Eigen::Index>(i)) = camera.transpose() * reflectances[i].onDomain().cwiseProduct(light);
    }
    return table;
  };
  Charts charts;
  for (const char* text : {"led:628:14", "led:525:24", "led:460:16", "phosphor:450:20:560:120:0.8"}) {
    charts.emitters.push_back(seen(emittersFrom(text, library).front().spectrum.onDomain(), text));
  }
  charts.target = seen(library.illuminant(target).onDomain() / 100, "target");
  return charts;
}

ChartTable noisy(ChartTable table, double noise, std::uint64_t seed, std::uint64_t chart) {
  std::uint64_t place = 0;
  for (double& value : table.rgb.reshaped()) {
    value *= 1 + noise * normalNumber(seed, chart, place++);
  }
  return table;
}

/// Drives of noisy charts lie about those without noise as their intervals say.
TEST(MatchIntervals, CoverTheTruth) {
  const bool isLong = std::getenv("METAMER_LONG") != nullptr;
  const int captures = isLong ? 300 : 40;
  const Eigen::Matrix3d xyzFromCamera = spectral::testLibrary().colourSpace("ACEScg").linear.xyzFromRgb();
  const auto match = [&](std::vector<ChartTable> emitters, const ChartTable& target) {
    return matchCharts({}, std::move(emitters), target, xyzFromCamera);
  };
  for (const char* target : {"A", "D65", "FL2"}) {
    const Charts charts = chartsUnder(target);
    const MatchOutcome truth = match(charts.emitters, charts.target);
    const double mean = summaryOf(differencesOf(truth)).mean;
    double drives = 0;
    double means = 0;
    for (int i = 0; i < captures; ++i) {
      const auto seed = 100 + static_cast<std::uint64_t>(i);
      std::vector<ChartTable> seen;
      for (const ChartTable& chart : charts.emitters) {
        seen.push_back(noisy(chart, 0.01, seed, seen.size()));
      }
      IntervalOptions options;
      options.noise.relative = 0.01;
      options.samples = isLong ? 500 : 100;
      const MatchIntervals found = matchIntervals(seen, noisy(charts.target, 0.01, seed, 9), match, options);
      drives += ((found.drives.low.array() <= truth.match.drives.array()) &&
                 (truth.match.drives.array() <= found.drives.high.array()))
                    .cast<double>()
                    .mean() /
                captures;
      means += (found.mean.low <= mean && mean <= found.mean.high ? 1.0 : 0.0) / captures;
    }
    std::printf("%s: of %d captures the 95 %% intervals cover %.1f %% of the drives, %.1f %% of the mean CIEDE2000\n",
                target, captures, 100 * drives, 100 * means);
    // Four numbers a capture that hang together: two standard errors of a share of 0.95.
    EXPECT_GE(drives, isLong ? 0.92 : 0.89);
    // One number a capture, and no normal one.
    EXPECT_GE(means, 0.88);
  }
}

}  // namespace
}  // namespace metamer::stage
