// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "metamer/ocio/stage_files.h"
#include "metamer/spectral/data_library.h"

namespace metamer::ocio {

/// A config for a solved wall: the colour spaces "NAME camera" (the camera's linear RGB), "NAME wall out of frustum"
/// and "NAME wall in frustum" (linear wall drives, to be converted to), and the look "NAME post-correction" (process
/// space "NAME camera"). They are added to a new config of profile 2.1, or to a base, whose text stays byte for byte.
/// @param file  where the text will be written: files that a base names must be found from there too
/// @param base  config to add to, of any profile from 2.0 on; empty: a new one
/// @param signalFile  what is sent for wall drives (writeStageFiles); then also the spaces "NAME signal out of frustum"
///         and "NAME signal in frustum". Empty: none
/// @return its text, which the OCIO at hand has loaded where it knows the profile
/// @throws spectral::InputError: the base cannot be read, lacks the role aces_interchange or a space for its reference,
///         or has one of the names; a name that OCIO takes apart
std::string stageConfigText(const StageMatrices& stage, const spectral::DataLibrary& library,
                            const std::filesystem::path& file, const std::filesystem::path& base = {},
                            const std::filesystem::path& signalFile = {});

}  // namespace metamer::ocio
