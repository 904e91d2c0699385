// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace metamer::stage {

/// CIEDE2000 of each patch of a chart against the same patch of a target, both linear RGB.
/// @param rgb, target     3 x patches
/// @param xyzFromRgb      camera RGB to XYZ, any scale
/// @param whiteRgb        what counts as white (L* = 100) in both
/// @return one a patch; not a number where white has no luminance
/// @throws spectral::InputError where rgb and target differ in patches
std::vector<double> chartDifferences(const Eigen::Matrix3Xd& rgb, const Eigen::Matrix3Xd& target,
                                     const Eigen::Matrix3d& xyzFromRgb, const Eigen::Vector3d& whiteRgb);

/// Mean and largest of some differences, over all of them or some patches (0 ... differences - 1); 0 over none.
struct DifferenceSummary {
  double mean = 0;
  double max = 0;
};
DifferenceSummary summaryOf(const std::vector<double>& differences);
/// @throws spectral::InputError for a patch that is not there
DifferenceSummary summaryOf(const std::vector<double>& differences, const std::vector<int>& patches);

}  // namespace metamer::stage
