// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "device/recently_used.h"
#include "drivers/opencl.h"

namespace metamer::ofx {

/// The plug-in's kernels, built once for each context and device that a host renders on; the latest few are kept. Safe
/// between threads.
class OpenClPrograms {
 public:
  explicit OpenClPrograms(std::shared_ptr<const OpenCl> library) : m_library(std::move(library)) {}

  /// A kernel of this name, the caller's alone: arguments are a kernel's state. Null where the device cannot run it.
  /// @throws DeviceError where the driver does not build the program, with its compiler's first line; that is
  ///         remembered, and it is not asked again.
  OpenCl::Owned kernel(OpenCl::Handle context, OpenCl::Handle device, const char* name);

 private:
  struct Entry {
    bool isAt(OpenCl::Handle itsContext, OpenCl::Handle itsDevice) const {
      return context == itsContext && device == itsDevice;
    }

    OpenCl::Handle context;
    OpenCl::Handle device;
    /// Holds the context too, so that no other one gets its address. Kept where the build has failed, for the same.
    std::shared_ptr<void> program;
    std::string problem;
  };

  Entry build(OpenCl::Handle context, OpenCl::Handle device) const;

  std::shared_ptr<const OpenCl> m_library;
  RecentlyUsed<Entry> m_entries;
};

}  // namespace metamer::ofx
