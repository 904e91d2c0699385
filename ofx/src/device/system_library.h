// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace metamer::ofx {

/// A library that the system has or has not, loaded while the plug-in runs. Never unloaded: drivers leave threads and
/// handlers behind.
class SystemLibrary {
 public:
  /// @param name  as the system's loader takes it, UTF-8. Empty where there is none.
  static std::optional<SystemLibrary> load(const std::string& name);

  /// Null where the library does not export it.
  void* symbol(const char* name) const;

 private:
  explicit SystemLibrary(void* handle) : m_handle(handle) {}

  void* m_handle;
};

}  // namespace metamer::ofx
