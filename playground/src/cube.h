// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "session.h"

namespace metamer::playground {

/// Working spaces that a cube can be made for: "sRGB", and all with a log curve.
std::vector<std::string> cubeSpaces(const spectral::DataLibrary& library);

/// The recipe's transform as a .cube: signals of a space in and out, the exact engine at every node.
/// @param size  nodes a side, 2 to 65. @throws spectral::InputError for another size, or a space not of cubeSpaces()
std::string cubeText(Session& session, const std::string& space, int size);

}  // namespace metamer::playground
