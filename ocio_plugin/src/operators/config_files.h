// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include <string>

namespace metamer::ocio {

namespace OCIO = OCIO_NAMESPACE;

/// Refuses a config that OpenColorIO would read without end: a file of its transforms, wherever the search path finds
/// it, that is a device, a pipe or a folder, or a small .ctf or .clf whose references lead to one or back to it.
/// @param where  what an error calls the config
/// @throws spectral::InputError naming the config and the file as it stands there
void refuseEndlessFiles(const OCIO::Config& config, const std::string& where);

}  // namespace metamer::ocio
