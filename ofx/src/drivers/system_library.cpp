// SPDX-License-Identifier: Apache-2.0
#include "drivers/system_library.h"

#include "metamer/spectral/platform.h"

#if defined(_WIN32)
#include <windows.h>

#include "metamer/spectral/path_text.h"
#else
#include <dlfcn.h>
#endif

namespace metamer::ofx {

std::optional<SystemLibrary> SystemLibrary::load(const std::string& name) {
#if defined(_WIN32)
  void* const handle = LoadLibraryW(spectral::pathOf(name).c_str());
#else
  void* const handle = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
#endif
  if (handle == nullptr) {
    return std::nullopt;
  }
  return SystemLibrary(handle);
}

std::optional<SystemLibrary> SystemLibrary::loadOr(const char* variable, const std::string& name) {
  const std::string chosen = spectral::environmentValue(variable).value_or(name);
  return chosen.empty() || chosen == "off" ? std::nullopt : load(chosen);
}

void* SystemLibrary::symbol(const char* name) const {
#if defined(_WIN32)
  return reinterpret_cast<void*>(GetProcAddress(static_cast<HMODULE>(m_handle), name));
#else
  return dlsym(m_handle, name);
#endif
}

}  // namespace metamer::ofx
