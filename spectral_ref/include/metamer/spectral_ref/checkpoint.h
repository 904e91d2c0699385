// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <vector>

namespace metamer::spectral_ref {

/// Takes bytes, in order.
using ByteSink = std::function<void(const void* bytes, std::size_t size)>;

/// Writes a state so that it appears whole or not at all, with a check sum behind it.
/// @param state  hands all its bytes to the sink that it is given, as Renderer::writeState does
/// @throws spectral::InputError (full disk; an older checkpoint stays as it was)
void writeCheckpoint(const std::function<void(const ByteSink&)>& state, const std::filesystem::path& file);

/// The bytes of a state.
/// @throws spectral::InputError: unreadable, damaged
std::vector<unsigned char> readCheckpoint(const std::filesystem::path& file);

}  // namespace metamer::spectral_ref
