// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace metamer::lutgen {

/// One picture of a call.
struct Frame {
  int number = 0;
  std::filesystem::path input;
  std::filesystem::path output;
};

/// The pictures that names, patterns of frames or not, stand for.
/// @param frames  "1001-1100"; empty: all that are there, or the one picture without a pattern
/// @throws spectral::InputError: a pattern on one side only, frames that are missing (all named), outputs that cannot
/// be
///         written, or that are one file
std::vector<Frame> framesOf(const std::string& input, const std::string& output, const std::string& frames);

/// How the threads are shared: frames at a time, and threads within each.
struct ThreadShare {
  int frames = 1;
  int inFrame = 1;
};
/// @param threads  0: as many as the machine has
/// @param frameBytes  that a frame takes in memory: no more at a time than a quarter of the machine's holds
ThreadShare shareThreads(int threads, std::size_t frameCount, std::uint64_t frameBytes);

/// Calls body for each frame, `share.frames` at a time, and done(frame, count so far) after each, one call at a time.
/// Stops early when one fails. @throws what the first failing frame (in their order) threw
void forEachFrame(const std::vector<Frame>& frames, const ThreadShare& share,
                  const std::function<void(const Frame&)>& body,
                  const std::function<void(const Frame&, std::size_t)>& done);

}  // namespace metamer::lutgen
