// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "metamer/stage/chart_expectation.h"

namespace metamer::stage {

/// How a chart's patches really lie, against their names.
struct Arrangement {
  std::string words;    ///< "mirrored left to right", "shifted by 1 column"; empty: as named
  double asNamed = 0;   ///< misfit of the chart as it is named
  double arranged = 0;  ///< misfit as the words have it
};

/// Share of a chart's variation that its reflectances do not explain, over channels with light: about 0.01 to 0.05 for
/// the chart itself, 1 for patches in another order.
double misfitOf(const Eigen::MatrixXd& bands, const Eigen::Matrix3Xd& rgb);

/// The arrangement that explains a chart best. Needs the expectation's grid; without it only `asNamed` is found.
/// @param rgb  3 x the expectation's known patches
Arrangement arrangementOf(const ChartExpectation& expectation, const Eigen::Matrix3Xd& rgb);

}  // namespace metamer::stage
