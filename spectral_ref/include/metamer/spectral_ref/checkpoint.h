// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace metamer::spectral_ref {

/// Writes Renderer::state() so that it appears whole or not at all, with a check sum behind it.
/// @throws spectral::InputError (full disk; an older checkpoint stays as it was)
void writeCheckpoint(const std::vector<unsigned char>& state, const std::filesystem::path& file);

/// @throws spectral::InputError: unreadable, damaged
std::vector<unsigned char> readCheckpoint(const std::filesystem::path& file);

}  // namespace metamer::spectral_ref
