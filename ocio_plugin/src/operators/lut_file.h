// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace metamer::ocio {

/// Refuses what OpenColorIO must not be given: a LUT file that is a device or a pipe, a .ctf whose references lead
/// to one, to no file, or back to itself, a .cube whose domain falls.
/// @throws spectral::InputError naming the file that holds the reference or the keyword, and either
void refuseOddLut(const std::filesystem::path& file);

/// All files that a .ctf or .clf leads to by its references, once it has passed refuseOddLut(); of others, none.
std::vector<std::filesystem::path> filesReferredTo(const std::filesystem::path& file);

/// What to do about a LUT file that OpenColorIO cannot read, where its text tells: a keyword of another program. Empty
/// where it does not.
std::string remedyOfLut(const std::filesystem::path& file);

}  // namespace metamer::ocio
