// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "metamer/spectral/data_library.h"
#include "metamer/stage/chart_table.h"
#include "metamer/stage/emitter_match.h"
#include "stage/stage_json.h"

namespace metamer::lutgen {

/// Drives of several emitters, and what the chart looks like in their light.
struct MatchOutcome {
  std::string target;
  std::string method;
  std::string weights;       ///< of mrm; empty for the others
  std::string observer;      ///< or what the camera's RGB is
  std::string reflectances;  ///< or where the charts are from
  std::vector<std::string> emitters;
  std::vector<bool> models;  ///< emitters that were not measured
  stage::EmitterMatch match;
  std::vector<std::string> patches;
  Eigen::Matrix3Xd wanted;          ///< the chart in the target light, as the observer responds
  Eigen::Matrix3Xd made;            ///< in the emitters' light
  Eigen::Matrix3d xyzFromResponse;  ///< any scale
  Eigen::Vector3d white;            ///< response to white
  std::optional<double> spectralSimilarity;
  std::vector<stage::ExcludedPatch> excluded;
  std::vector<std::string> notes;
};

/// CIEDE2000 of each patch.
std::vector<double> differencesOf(const MatchOutcome& outcome);
/// What the emitters cannot do, and why; added to the notes.
void addReachNotes(MatchOutcome& outcome);

Json toJson(const MatchOutcome& outcome);
std::string reportOf(const MatchOutcome& outcome, const std::string& figure);
std::string summaryOf(const MatchOutcome& outcome);
/// The chart as squares in squares. @throws spectral::InputError
void writeFigure(const MatchOutcome& outcome, const spectral::DataLibrary& library, const std::filesystem::path& file);

}  // namespace metamer::lutgen
