// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace metamer::spectral_ref {

/// Refuses an OBJ file that its reader must not be given: bytes that are no text, a vertex without its numbers, a face
/// that names a vertex, normal or texture coordinate that is not there, or is cut short.
/// @throws spectral::InputError naming the file, the line, the value and the remedy
void checkObj(const std::filesystem::path& file);

}  // namespace metamer::spectral_ref
