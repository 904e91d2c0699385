// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "metamer/spectral/data_library.h"

namespace metamer::ocio {

/// A config to add looks to, as text of OCIO profile 2.1: the roles that programs ask for, configSpaces(), the common
/// displays and ACES 1 views.
/// @param name     of the config
/// @param lutPath  its search path
std::string newConfigText(const std::string& name, const std::string& description, const std::string& lutPath,
                          const spectral::DataLibrary& library);

}  // namespace metamer::ocio
