// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "metamer/spectral/data_library.h"
#include "metamer/stage/emitter_match.h"

namespace metamer::lutgen {

/// The emitters of a fixture, as a command line names them.
struct Fixture {
  std::vector<std::string> names;
  std::vector<bool> models;  ///< not measured
  std::vector<spectral::Spectrum> spectra;
  stage::EmitterColumns columns;
  std::vector<std::string> notes;
};

/// @throws spectral::InputError
Fixture readFixture(const std::vector<std::string>& texts, const spectral::DataLibrary& library);

/// A mixed light as a spectrum.
spectral::Spectrum lightOf(const spectral::DomainSamples& power);

/// Limits as a command line gives them: none, one for all, or one an emitter.
struct FixtureLimits {
  std::vector<double> largest;
  std::vector<double> power;
  double budget = 0;  ///< 0: none
};

void addFixtureLimits(CLI::App& command, FixtureLimits& limits);
/// @throws spectral::InputError where they are neither one nor as many as the emitters
stage::DriveLimits limitsOf(const FixtureLimits& limits, std::size_t emitterCount);

/// XYZ from an observer's response to materials in a light: the observer's own matrix, or least squares over a
/// training set.
Eigen::Matrix3d xyzFromResponseUnder(const spectral::Spectrum& light, const spectral::Observer& observer,
                                     const spectral::DataLibrary& library);

}  // namespace metamer::lutgen
