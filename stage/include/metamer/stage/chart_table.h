// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace metamer::stage {

/// The patches of a chart as a camera saw them in one light.
struct ChartTable {
  std::string where;               ///< what messages call it
  std::vector<std::string> names;  ///< one a patch, all different
  Eigen::Matrix3Xd rgb;            ///< linear camera RGB; not a number where a value is missing
};

/// Charts may not have more patches than this.
inline constexpr std::size_t kMostPatches = 100'000;

/// Reads a chart of CSV text with the header "patch,R,G,B" (any order of columns, further ones are ignored; comma,
/// semicolon or tab; names may be quoted). An empty cell, "nan" or "inf" is a missing value; lines that begin with '#'
/// are comments.
/// @throws spectral::InputError with the line: no such header, a value that is no number, a name given twice, no
/// patches
ChartTable parseChart(const std::string& text, const std::string& where);

/// A patch that was left out, and why.
struct ExcludedPatch {
  std::string name;
  std::string reason;
};

/// Charts of the same patches in the same order.
struct AlignedCharts {
  std::vector<std::string> names;
  std::vector<Eigen::Matrix3Xd> charts;  ///< as many as were given
  std::vector<ExcludedPatch> excluded;
};

/// Keeps the patches that every chart holds, by their names, in the order of the last chart, and leaves out missing and
/// saturated ones, and those of `unwanted`.
/// @param saturation  from this value on a channel is clipped. Without it, a chart's clipping shows as its largest
///                    value where two or more different patches share it to the last digit
/// @throws spectral::InputError: no charts, a chart whose names are not as many as its patches
AlignedCharts alignCharts(const std::vector<ChartTable>& charts, std::optional<double> saturation,
                          const std::vector<std::string>& unwanted = {});

}  // namespace metamer::stage
