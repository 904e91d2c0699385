// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "metamer/spectral/data_library.h"
#include "metamer/stage/fixture.h"

namespace metamer::lutgen {

/// Limits as a command line gives them: none, one for all, or one an emitter.
struct FixtureLimits {
  std::vector<double> largest;
  std::vector<double> power;
  double budget = 0;  ///< 0: none
};

/// --priority skin[:WEIGHT], read by stage::skinWeightFrom.
void addPriority(CLI::App& command, std::string& priority);

void addFixtureLimits(CLI::App& command, FixtureLimits& limits);
/// @throws spectral::InputError where they are neither one nor as many as the emitters
stage::DriveLimits limitsOf(const FixtureLimits& limits, std::size_t emitterCount);

/// XYZ from an observer's response to materials in a light: the observer's own matrix, or least squares over a
/// training set.
Eigen::Matrix3d xyzFromResponseUnder(const spectral::Spectrum& light, const spectral::Observer& observer,
                                     const spectral::DataLibrary& library);

/// A light behind a filter.
/// @param text  NAME or FILE, with ":density" where it is not 1
/// @throws spectral::InputError
spectral::Spectrum filteredLight(const spectral::Spectrum& light, const std::string& text,
                                 const spectral::DataLibrary& library);

/// What --samples may be: 0, or enough. Empty where it is, else what CLI11 says.
std::string samplesCheck(const std::string& text);

}  // namespace metamer::lutgen
