// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace metamer::ocio {

/// Refuses a .cube whose domain falls, which OpenColorIO takes and turns colours round by, or is no number.
/// @param file  what messages name
/// @param text  the file, to the first line of its table at least
/// @throws spectral::InputError naming the keyword
void refuseOddDomain(const std::filesystem::path& file, const std::string& text);

}  // namespace metamer::ocio
