// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <string>

#include "metamer/stage/chart_table.h"
#include "refusal.h"

/// Whatever the bytes are, they are a chart whose usable patches are all numbers, or one short line of error.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace metamer;
  try {
    const auto chart = stage::parseChart(std::string(reinterpret_cast<const char*>(data), size), "input");
    require(!chart.names.empty() && chart.rgb.cols() == static_cast<Eigen::Index>(chart.names.size()));
    const auto aligned = stage::alignCharts({chart, chart}, std::nullopt);
    require(aligned.charts.size() == 2 && aligned.charts[0].allFinite());
    require(aligned.names.size() + aligned.excluded.size() == chart.names.size());
  } catch (const spectral::InputError& error) {
    checkRefusal(error);
  }
  return 0;
}
