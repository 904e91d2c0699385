// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <list>
#include <memory>
#include <mutex>
#include <string>

#include "device/opencl.h"

namespace metamer::ofx {

/// The plug-in's kernels, built once for each context and device that a host renders on; the latest few are kept. Safe
/// between threads.
class OpenClPrograms {
 public:
  explicit OpenClPrograms(std::shared_ptr<const OpenCl> library) : m_library(std::move(library)) {}

  /// A kernel of this name, the caller's alone: arguments are a kernel's state. Null where the device cannot run it.
  /// @throws OpenClError where the driver does not build the program, with its compiler's first line; that is
  ///         remembered, and it is not asked again.
  OpenCl::Owned kernel(OpenCl::Handle context, OpenCl::Handle device, const char* name);

 private:
  struct Entry {
    OpenCl::Handle context;
    OpenCl::Handle device;
    /// Holds the context too, so that no other one gets its address. Kept where the build has failed, for the same.
    std::shared_ptr<void> program;
    std::string problem;
  };

  Entry entry(OpenCl::Handle context, OpenCl::Handle device);
  Entry build(OpenCl::Handle context, OpenCl::Handle device) const;

  std::shared_ptr<const OpenCl> m_library;
  std::mutex m_mutex;
  std::list<Entry> m_entries;  ///< latest first
};

}  // namespace metamer::ofx
