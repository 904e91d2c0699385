// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "device/recently_used.h"
#include "drivers/objective_c.h"

namespace metamer::ofx {

/// The plug-in's kernels, built once for each device that a host renders on; the latest few are kept. Safe between
/// threads.
class MetalPrograms {
 public:
  explicit MetalPrograms(std::shared_ptr<const ObjectiveC> library) : m_library(std::move(library)) {}

  /// The pipeline of a kernel of this name. Null where Metal has none: it knows no doubles.
  /// @throws DeviceError where the device does not compile the kernels, with its compiler's first line; that is
  ///         remembered, and it is not asked again
  std::shared_ptr<void> pipeline(ObjectiveC::Object device, const std::string& name);

 private:
  struct Entry {
    std::shared_ptr<void> device;  ///< held, so that no other one gets its address
    std::map<std::string, std::shared_ptr<void>> pipelines;
    std::string problem;
  };

  Entry build(ObjectiveC::Object device) const;
  std::shared_ptr<void> text(const char* characters) const;
  std::string wordsOf(ObjectiveC::Object error) const;

  std::shared_ptr<const ObjectiveC> m_library;
  RecentlyUsed<Entry> m_entries;
};

}  // namespace metamer::ofx
