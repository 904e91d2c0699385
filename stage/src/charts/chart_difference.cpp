// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/chart_difference.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/colorimetry.h"

namespace metamer::stage {

std::vector<double> chartDifferences(const Eigen::Matrix3Xd& rgb, const Eigen::Matrix3Xd& target,
                                     const Eigen::Matrix3d& xyzFromRgb, const Eigen::Vector3d& whiteRgb) {
  spectral::requireAsMany("patches", rgb.cols(), "the target has", target.cols());
  const Eigen::Vector3d white = xyzFromRgb * whiteRgb;
  std::vector<double> differences(static_cast<std::size_t>(rgb.cols()), std::numeric_limits<double>::quiet_NaN());
  if (!(white.minCoeff() > 0)) {
    return differences;
  }
  for (Eigen::Index i = 0; i < rgb.cols(); ++i) {
    differences[static_cast<std::size_t>(i)] = spectral::deltaE2000(spectral::lab(xyzFromRgb * rgb.col(i), white),
                                                                    spectral::lab(xyzFromRgb * target.col(i), white));
  }
  return differences;
}

DifferenceSummary summaryOf(const std::vector<double>& differences) {
  std::vector<int> all(differences.size());
  std::iota(all.begin(), all.end(), 0);
  return summaryOf(differences, all);
}

DifferenceSummary summaryOf(const std::vector<double>& differences, const std::vector<int>& patches) {
  DifferenceSummary summary;
  for (const int patch : patches) {
    spectral::requireWithin("patch", patch, 0, static_cast<double>(differences.size()) - 1);
    const double difference = differences[static_cast<std::size_t>(patch)];
    summary.mean += difference / static_cast<double>(patches.size());
    summary.max = std::max(summary.max, difference);
  }
  return summary;
}

}  // namespace metamer::stage
