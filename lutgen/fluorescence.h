// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace metamer::lutgen {

/// Prints what a fluorescent surface's file holds, and its colour under some lights.
void showFluorescence(const std::string& file, const std::vector<std::string>& lights);

/// Writes a matrix's compact form, and says how far it is from the matrix.
/// @param lights  that both are judged under
void fitFluorescence(const std::string& file, const std::string& output, const std::vector<std::string>& lights);

}  // namespace metamer::lutgen
