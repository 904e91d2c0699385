// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "metamer/spectral/data_library.h"
#include "metamer/stage/chart_table.h"
#include "metamer/stage/rgb_wall.h"
#include "metamer/stage/stage_description.h"

namespace metamer::lutgen {

/// The spectra of a stage that was given as such.
struct CaptureSpectra {
  std::array<spectral::DomainSamples, 3> emitters;
  spectral::Spectrum target;
};

/// A stage file with all that it names read: ready to be solved.
struct StageCapture {
  stage::WallCapture wall;
  Eigen::Matrix3d xyzFromCamera;         ///< for colour differences
  Eigen::Vector3d cameraWhite{1, 1, 1};  ///< what is neutral in that space, for configs
  std::optional<CaptureSpectra> spectra;
  int columns = 6;          ///< of the chart, for pictures of it
  std::string colourSpace;  ///< what that matrix is: a space's name, or how it was found
  int whitePatch = -1;      ///< the chart's white; -1: none fit for it
  std::vector<int> skinPatches;
  std::vector<stage::ExcludedPatch> excluded;
  std::vector<std::string> notes;  ///< what a user should know about the input
};

/// The patch of a name, without regard to case; else the only one that begins with it; else -1.
int patchNamed(const std::vector<std::string>& names, const std::string& name);

/// Reads spectra, charts, pictures and the environment.
/// @param checkPictures  prefix of pictures with the sampled squares; empty: none
/// @throws spectral::InputError
StageCapture readCapture(const stage::StageDescription& stage, const spectral::DataLibrary& library,
                         const std::string& checkPictures = {});

}  // namespace metamer::lutgen
