// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "metamer/ocio/stage_files.h"
#include "metamer/spectral/data_library.h"

namespace metamer::ocio {

/// A config for a solved wall: the colour spaces "NAME camera" (the camera's linear RGB), "NAME wall out of frustum"
/// and "NAME wall in frustum" (linear wall drives, to be converted to), and the look "NAME post-correction" (process
/// space "NAME camera"). A new config also has ACES2065-1, ACEScg, Raw and a plain sRGB display with and without the
/// look; it has OCIO profile 2.0. A base config keeps all that it has.
/// @param base  config to add to; empty: a new one
/// @return its text
/// @throws spectral::InputError: the base cannot be read, lacks the role aces_interchange, or has one of the names
std::string stageConfigText(const StageMatrices& stage, const spectral::DataLibrary& library,
                            const std::filesystem::path& base = {});

}  // namespace metamer::ocio
