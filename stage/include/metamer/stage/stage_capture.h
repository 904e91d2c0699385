// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "metamer/spectral/data_library.h"
#include "metamer/stage/chart_expectation.h"
#include "metamer/stage/chart_table.h"
#include "metamer/stage/panel_eotf.h"
#include "metamer/stage/rgb_wall.h"
#include "metamer/stage/stage_description.h"

namespace metamer::stage {

/// The spectra of a stage that was given as such.
struct CaptureSpectra {
  std::array<spectral::DomainSamples, 3> emitters;
  spectral::Spectrum target;
};

/// A stage file with all that it names read: ready to be solved.
struct StageCapture {
  WallCapture wall;
  Eigen::Matrix3d xyzFromCamera;         ///< for colour differences
  Eigen::Vector3d cameraWhite{1, 1, 1};  ///< what is neutral in that space, for configs
  std::optional<CaptureSpectra> spectra;
  int columns = 6;                               ///< of the chart, for pictures of it
  std::string colourSpace;                       ///< what that matrix is: a space's name, or how it was found
  int whitePatch = -1;                           ///< the chart's white; -1: none fit for it
  bool whiteIsFromTarget = false;                ///< w_avg is the white patch's, over its reflectance
  std::optional<ChartExpectation> expectation;   ///< of a photographed chart whose patches are known
  std::optional<std::array<PanelEotf, 3>> eotf;  ///< of the wall's channels, where ramps were captured
  std::vector<int> skinPatches;
  std::optional<WallCapture> skins;  ///< virtual skins in place of the chart, where spectra are known
  std::vector<ExcludedPatch> excluded;
  std::vector<std::string> notes;  ///< what a user should know about the input
};

/// What the files of a stage hold, for a stage that is not given as spectra.
struct StageReadings {
  std::array<Eigen::Vector3d, 3> primaries;
  std::array<ChartTable, 3> charts;
  ChartTable target;
  std::vector<std::string> notes;  ///< of the reading
};

/// XYZ from an observer's response to materials in a light: the observer's own matrix, or one solved over a training
/// set. At any scale.
using XyzFromResponse =
    std::function<Eigen::Matrix3d(const spectral::Spectrum& light, const spectral::Observer& observer)>;

/// Puts a capture together.
/// @param readings          empty where the description has spectra
/// @param environmentWhite  w_avg, where the description names an environment's picture
/// @throws spectral::InputError: names that are not there, charts that share no patch, no white to go by
StageCapture captureOf(const StageDescription& description, const spectral::DataLibrary& library,
                       const XyzFromResponse& xyzFromResponse, const std::optional<StageReadings>& readings,
                       const std::optional<Eigen::Vector3d>& environmentWhite);

}  // namespace metamer::stage
