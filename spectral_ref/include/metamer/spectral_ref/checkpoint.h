// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>

namespace metamer::spectral_ref {

/// Takes bytes, in order.
using ByteSink = std::function<void(const void* bytes, std::size_t size)>;

/// Writes a state so that it appears whole or not at all, with a check sum behind it.
/// @param state  hands all its bytes to the sink that it is given, as Renderer::writeState does
/// @throws spectral::InputError (full disk; an older checkpoint stays as it was)
void writeCheckpoint(const std::function<void(const ByteSink&)>& state, const std::filesystem::path& file);

/// A state, to be taken piece by piece and in order.
struct ByteSource {
  std::function<void(void* bytes, std::size_t size)> take;  ///< stores the next `size` bytes
  std::uint64_t size = 0;                                   ///< of the whole state
};

/// Reads a state piece by piece, with no copy of the whole. Its check sum is compared before `state` sees anything.
/// @param state  takes bytes from the source that it is given, as Renderer::restore does
/// @throws spectral::InputError: unreadable, damaged
void readCheckpoint(const std::filesystem::path& file, const std::function<void(const ByteSource&)>& state);

}  // namespace metamer::spectral_ref
