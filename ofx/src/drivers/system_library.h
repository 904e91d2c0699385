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

  /// The library that the environment's variable names; where it names none, the system's. Empty where there is none,
  /// or the variable says "off".
  /// @param name  empty: the system has none
  static std::optional<SystemLibrary> loadOr(const char* variable, const std::string& name);

  /// Null where the library does not export it.
  void* symbol(const char* name) const;

  /// The same as a function. False where the library does not export it.
  template <typename Function>
  bool find(Function*& function, const char* name) const {
    function = reinterpret_cast<Function*>(symbol(name));
    return function != nullptr;
  }

 private:
  explicit SystemLibrary(void* handle) : m_handle(handle) {}

  void* m_handle;
};

}  // namespace metamer::ofx
