// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "metamer/spectral/data_library.h"
#include "metamer/stage/chart_sampler.h"
#include "metamer/stage/chart_table.h"
#include "metamer/stage/stage_description.h"

namespace metamer::lutgen {

/// Reads charts: a CSV of patches, or any picture OIIO reads (its values taken as linear) with the chart's corners.
class ChartReader {
 public:
  /// As stage::ChartSampler.
  ChartReader(const stage::StageLayout& layout, const spectral::DataLibrary& library,
              const std::filesystem::path& folder, std::optional<double> saturation = std::nullopt)
      : m_sampler(layout, library, folder, saturation) {}

  /// A chart that lies turned leaves a note.
  /// @param checkPicture  where given, the picture with the sampled squares drawn in goes there
  /// @throws spectral::InputError
  stage::ChartTable read(const stage::StageChart& chart, std::vector<std::string>& notes,
                         const std::filesystem::path& checkPicture = {}) const;

 private:
  stage::ChartSampler m_sampler;
};

/// The colour of a wall's patch: as given, or the mean over its box of pixels.
/// @throws spectral::InputError
Eigen::Vector3d readPrimary(const stage::StagePrimary& primary);

}  // namespace metamer::lutgen
