// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "device/recently_used.h"
#include "drivers/cuda.h"

namespace metamer::ofx {

/// The plug-in's kernels, loaded once for each context that a host renders in; the latest few are kept. Safe between
/// threads.
class CudaPrograms {
 public:
  explicit CudaPrograms(std::shared_ptr<const Cuda> library) : m_library(std::move(library)) {}

  /// A kernel of this name in the thread's context, which lies at `place`.
  /// @throws DeviceError where the driver does not load the module; that is remembered, and it is not asked again
  Cuda::Function kernel(Cuda::Context context, const void* place, const char* name);

 private:
  struct Entry {
    const void* place;
    std::shared_ptr<void> module;  ///< null where the driver refused
    std::string problem;
  };

  Entry load(Cuda::Context context, const void* place) const;

  std::shared_ptr<const Cuda> m_library;
  RecentlyUsed<Entry> m_entries;
};

}  // namespace metamer::ofx
