// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "metamer/spectral/data_library.h"

namespace metamer::stage {

/// What is known of a chart before it is photographed: its patches' reflectances, and where they lie.
///
/// Whatever light a chart stands in and whatever camera sees it, a channel's values are sums over wavelengths of
/// reflectance times something that is not negative: `bands` times a non-negative vector. So a capture can be judged
/// without knowing light or camera (misfits of 0.2 % for lamps and LED lights, of 1 % where the chart is another
/// copy).
struct ChartExpectation {
  std::string set;                  ///< its name, for messages
  std::vector<Eigen::Index> known;  ///< places in the capture of the patches that the set holds, rising
  Eigen::MatrixXd bands;            ///< known patches x bands: mean reflectance in each band
  Eigen::VectorXd bandCentresNm;    ///< rising
  Eigen::VectorXd level;            ///< known patches: mean reflectance
  std::vector<Eigen::Index> greys;  ///< of the known patches, those of even reflectance
  std::vector<Eigen::Vector2i>
      cell;  ///< column and row of each known patch; empty where the set does not fill the grid
  int columns = 0;
  int rows = 0;
};

/// Fewer known patches than this say nothing.
inline constexpr std::size_t kFewestKnownPatches = 12;

/// @param names          patches of a capture
/// @param columns, rows  of the chart
/// @return nothing where the set knows fewer than kFewestKnownPatches of them
std::optional<ChartExpectation> expectationOf(const std::vector<std::string>& names,
                                              const spectral::ReflectanceSet& set, int columns, int rows);

/// How one channel of a chart is explained: values = bands * weights, weights not negative.
struct ChannelFit {
  Eigen::VectorXd weights;  ///< one a band
  Eigen::VectorXd fitted;   ///< one a patch
  double veil = 0;          ///< a part that all patches share, where asked for; may be negative
};

/// @param bands      patches x bands
/// @param values     one a patch
/// @param floor      values below it count as much as it: residuals are taken relative to |value| + floor; above 0
/// @param withVeil   whether a shared part is looked for
ChannelFit fitChannel(const Eigen::MatrixXd& bands, const Eigen::VectorXd& values, double floor, bool withVeil = false);

/// Relative noise of a capture's values (standard deviation over value), from what is left of each chart's strongest
/// channel when its reflectances have explained it. Uneven light and another copy of the chart count as noise.
/// @param charts  3 x patches each
double estimatedNoise(const ChartExpectation& expectation, const std::vector<Eigen::Matrix3Xd>& charts);

}  // namespace metamer::stage
