// SPDX-License-Identifier: Apache-2.0
#include "apply/sequence.h"

#include <OpenImageIO/sysutil.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <map>
#include <mutex>
#include <set>
#include <thread>

#include "apply/frames.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"

namespace metamer::lutgen {
namespace {

namespace fs = std::filesystem;
using spectral::InputError;

/// Proves each folder writable, and each output no folder, pipe or device.
void refuseUnwritable(const std::vector<Frame>& frames) {
  std::set<fs::path> folders;
  std::set<fs::path> outputs;
  for (const Frame& frame : frames) {
    std::error_code none;
    const fs::file_status status = fs::status(frame.output, none);
    if (fs::exists(status) && !fs::is_regular_file(status)) {
      throw InputError(spectral::utf8(frame.output), "output", "", "is a folder, pipe or device; name a file");
    }
    if (!outputs.insert(frame.output).second) {
      throw InputError(spectral::utf8(frame.output), "output", "", "would be written by two frames; check the pattern");
    }
    if (folders.insert(frame.output.parent_path()).second) {
      const spectral::PendingFile probe(frame.output);
    }
  }
}

}  // namespace

std::vector<Frame> framesOf(const std::string& input, const std::string& output, const std::string& frames) {
  const auto in = FramePattern::in(input);
  const auto out = FramePattern::in(output);
  std::error_code none;
  std::vector<Frame> result;
  // A file may bear a # in its name.
  if (!in || (frames.empty() && fs::is_regular_file(spectral::pathOf(input), none))) {
    if (!frames.empty()) {
      throw InputError(input, "frames", frames, "need a place for their number: shot.####.exr or shot.%04d.exr");
    }
    result.push_back({0, spectral::pathOf(input), spectral::pathOf(output)});
    refuseUnwritable(result);
    return result;
  }
  if (!out) {
    throw InputError(output, "output", "", "needs a place for the frame's number, as the input: out.####.exr");
  }
  std::vector<int> missing;
  for (const int frame : frames.empty() ? in->framesThere() : framesFrom(frames)) {
    result.push_back({frame, spectral::pathOf(in->file(frame)), spectral::pathOf(out->file(frame))});
    if (!fs::exists(result.back().input, none)) {
      missing.push_back(frame);
    }
  }
  if (!missing.empty()) {
    std::sort(missing.begin(), missing.end());
    throw InputError(input, "frames", framesText(missing),
                     "are missing, " + std::to_string(missing.size()) + " of " + std::to_string(result.size()) +
                         "; render them, or leave them out of --frames");
  }
  refuseUnwritable(result);
  return result;
}

ThreadShare shareThreads(int threads, std::size_t frameCount, std::uint64_t frameBytes) {
  const auto all = static_cast<std::uint64_t>(threads > 0 ? static_cast<unsigned>(threads)
                                                          : std::max(1U, std::thread::hardware_concurrency()));
  const std::uint64_t inMemory = OIIO::Sysutil::physical_memory() / 4 / std::max<std::uint64_t>(frameBytes, 1);
  const std::uint64_t frames =
      std::max<std::uint64_t>(1, std::min({all, static_cast<std::uint64_t>(frameCount), inMemory}));
  return {static_cast<int>(frames), static_cast<int>(std::max<std::uint64_t>(1, all / frames))};
}

void forEachFrame(const std::vector<Frame>& frames, const ThreadShare& share,
                  const std::function<void(const Frame&)>& body,
                  const std::function<void(const Frame&, std::size_t)>& done) {
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> hasFailed = false;
  std::mutex mutex;
  std::size_t count = 0;
  std::map<std::size_t, std::exception_ptr> failures;
  const auto work = [&] {
    for (std::size_t k = next++; k < frames.size() && !hasFailed; k = next++) {
      try {
        body(frames[k]);
        const std::lock_guard<std::mutex> lock(mutex);
        done(frames[k], ++count);
      } catch (...) {
        hasFailed = true;
        const std::lock_guard<std::mutex> lock(mutex);
        failures[k] = std::current_exception();
      }
    }
  };
  std::vector<std::thread> workers;
  for (int k = 1; k < share.frames; ++k) {
    workers.emplace_back(work);
  }
  work();
  for (std::thread& worker : workers) {
    worker.join();
  }
  if (!failures.empty()) {
    std::rethrow_exception(failures.begin()->second);
  }
}

}  // namespace metamer::lutgen
