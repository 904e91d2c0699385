// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "metamer/spectral/data_library.h"
#include "metamer/stage/chart_table.h"
#include "metamer/stage/fixture.h"
#include "metamer/stage/skin_priority.h"

namespace metamer::stage {

/// How emitters are matched.
struct MatchRequest {
  std::string method = "mrm";        ///< as matchMethodFromName() takes it
  std::string weights = "absolute";  ///< of mrm: absolute, relative or perceptual
  DriveLimits limits;
  std::string where;      ///< what messages call the charts
  double skinWeight = 0;  ///< of mrm: each virtual skin beside a patch's 1
};

/// Virtual skins in the light of a match.
struct MatchSkins {
  int count = 0;
  double weight = 0;  ///< that drives were solved with
  SkinDifferences differences;
  std::vector<SkinTradeOff> tradeOffs;  ///< of mrm; by perceptual weights, where skin counts
};

/// Drives of several emitters, and what the chart looks like in their light.
struct MatchOutcome {
  std::string target;
  std::string method;
  std::string weights;       ///< of mrm; empty for the others
  std::string observer;      ///< or what the camera's RGB is
  std::string reflectances;  ///< or where the charts are from
  std::vector<std::string> emitters;
  std::vector<bool> models;  ///< emitters that were not measured
  EmitterMatch match;
  std::vector<std::string> patches;
  Eigen::Matrix3Xd wanted;                      ///< the chart in the target light, as the observer responds
  Eigen::Matrix3Xd made;                        ///< in the emitters' light
  std::vector<Eigen::Matrix3Xd> emitterCharts;  ///< under each emitter at a drive of 1
  Eigen::Matrix3d xyzFromResponse;              ///< any scale
  Eigen::Vector3d white;                        ///< response to white
  std::optional<double> spectralSimilarity;
  std::optional<MatchSkins> skins;  ///< where there are spectra
  std::vector<ExcludedPatch> excluded;
  std::vector<std::string> notes;
};

/// CIEDE2000 of each patch.
std::vector<double> differencesOf(const MatchOutcome& outcome);
/// What the emitters cannot do, and why; added to the notes.
void addReachNotes(MatchOutcome& outcome);

/// Drives from spectra (sections 2.4.1 to 2.4.3). Names in the outcome that are the caller's (target, reflectances)
/// stay empty.
/// @param materials        at least one
/// @param xyzFromResponse  of the observer under the target, at any scale
/// @param skins            virtual skins, for the request's weight of skin and what is said of them
/// @throws spectral::InputError: an unknown method or weights, and as the systems of emitter_match.h and their solution
MatchOutcome matchSpectra(const MatchRequest& request, const Fixture& fixture, const spectral::Spectrum& target,
                          const spectral::Observer& observer, const std::vector<spectral::Spectrum>& materials,
                          const Eigen::Matrix3d& xyzFromResponse, const std::vector<spectral::Spectrum>& skins = {});

/// Drives from pictures alone (section 2.5.2): the chart under each emitter, and under the target. Emitters, observer
/// and reflectances have no names yet in the outcome.
/// @throws spectral::InputError: the spectral method, an unknown one, unknown weights, a weight of skin, charts without
/// a common patch
MatchOutcome matchCharts(const MatchRequest& request, std::vector<ChartTable> emitterCharts, const ChartTable& target,
                         const Eigen::Matrix3d& xyzFromCamera);

}  // namespace metamer::stage
