// SPDX-License-Identifier: Apache-2.0
#include "system.h"

#include <cstdlib>
#include <fstream>
#include <stdexcept>

#if defined(_WIN32)
#include <windows.h>
// After windows.h.
#include <psapi.h>
#else
#include <dlfcn.h>
#include <unistd.h>
#endif

namespace bare_host {

LoadedLibrary::LoadedLibrary(const std::filesystem::path& file) {
#if defined(_WIN32)
  m_handle = LoadLibraryW(file.c_str());
  if (m_handle == nullptr) {
    throw std::runtime_error(textOf(file) + ": error " + std::to_string(GetLastError()));
  }
#else
  m_handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (m_handle == nullptr) {
    throw std::runtime_error(dlerror());
  }
#endif
}

LoadedLibrary::~LoadedLibrary() {
#if defined(_WIN32)
  FreeLibrary(static_cast<HMODULE>(m_handle));
#else
  dlclose(m_handle);
#endif
}

void* LoadedLibrary::symbol(const char* name) const {
#if defined(_WIN32)
  void* found = reinterpret_cast<void*>(GetProcAddress(static_cast<HMODULE>(m_handle), name));
#else
  void* found = dlsym(m_handle, name);
#endif
  if (found == nullptr) {
    throw std::runtime_error(std::string("the library does not export ") + name);
  }
  return found;
}

std::filesystem::path libraryOfEnvironment() {
#if defined(_WIN32)
  const wchar_t* given = _wgetenv(L"METAMER_OFX_LIBRARY");
#else
  const char* given = std::getenv("METAMER_OFX_LIBRARY");
#endif
  return given == nullptr ? std::filesystem::path() : std::filesystem::path(given);
}

std::string textOf(const std::filesystem::path& path) {
  const std::u8string text = path.u8string();
  return {text.begin(), text.end()};
}

std::filesystem::path pathOf(const std::string& text) {
  return std::u8string(text.begin(), text.end());
}

std::size_t residentBytes() {
#if defined(_WIN32)
  PROCESS_MEMORY_COUNTERS counters = {};
  K32GetProcessMemoryInfo(GetCurrentProcess(), &counters, sizeof(counters));
  return counters.WorkingSetSize;
#else
  std::size_t pages = 0;
  std::size_t resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
#endif
}

bool residentMemoryIsMeasurable() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return false;
#else
  return true;
#endif
}

}  // namespace bare_host
