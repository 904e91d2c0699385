// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "metamer/stage/stage_capture.h"

namespace metamer::lutgen {

/// Reads spectra, charts, pictures and the environment that a stage file names.
/// @param checkPictures  prefix of pictures with the sampled squares; empty: none
/// @throws spectral::InputError
stage::StageCapture readCapture(const stage::StageDescription& stage, const spectral::DataLibrary& library,
                                const std::string& checkPictures = {});

}  // namespace metamer::lutgen
