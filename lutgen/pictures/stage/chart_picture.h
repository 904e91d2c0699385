// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "metamer/spectral/data_library.h"
#include "metamer/stage/chart_table.h"
#include "metamer/stage/stage_description.h"

namespace metamer::lutgen {

/// Reads charts: a CSV of patches, or any picture OIIO reads (its values taken as linear) with the chart's corners.
class ChartReader {
 public:
  /// @throws spectral::InputError: names that do not fit the grid, an unknown reflectance set
  ChartReader(const stage::StageLayout& layout, const spectral::DataLibrary& library,
              const std::filesystem::path& folder, std::optional<double> saturation = std::nullopt);

  /// The mean of each patch's sampled square. A square outside the picture, or with pixels that are not finite, is a
  /// missing patch; one with clipped pixels gets the saturation value. Corners in the picture's order on a chart that
  /// lies turned are told by the chart's own reflectances, and turned with a note.
  /// @param checkPicture  where given, the picture with the sampled squares drawn in goes there
  stage::ChartTable read(const stage::StageChart& chart, std::vector<std::string>& notes,
                         const std::filesystem::path& checkPicture = {}) const;

 private:
  stage::ChartTable sample(const stage::StageChart& chart, std::vector<std::string>& notes,
                           const std::filesystem::path& checkPicture) const;

  stage::StageLayout m_layout;
  std::vector<std::string> m_names;
  Eigen::Matrix3Xd m_expected;  ///< linear RGB of the chart under an even light; empty where it is not known
  std::optional<double> m_saturation;
};

/// The colour of a wall's patch: as given, or the mean over its box of pixels.
/// @throws spectral::InputError
Eigen::Vector3d readPrimary(const stage::StagePrimary& primary);

}  // namespace metamer::lutgen
