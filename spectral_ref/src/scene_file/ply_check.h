// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace metamer::spectral_ref {

/// Refuses a PLY file that its reader must not be given: a header without an end or without a meaning, a body cut
/// short, a face that names a vertex that is not there.
/// @throws spectral::InputError naming the file, the line or element, the value and the remedy
void checkPly(const std::filesystem::path& file);

}  // namespace metamer::spectral_ref
