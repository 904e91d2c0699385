// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/platform.h"

#include <cstdlib>
#include <system_error>
#include <vector>

#include "metamer/spectral/path_text.h"

#if defined(_WIN32)
#include <io.h>
#include <process.h>
#include <windows.h>
#else
#include <dlfcn.h>
#include <unistd.h>
#if defined(__APPLE__)
#include <mach-o/dyld.h>
#elif defined(__linux__)
#include <sys/auxv.h>
#endif
#endif

namespace metamer::spectral {

std::FILE* openFile(const std::filesystem::path& path, const char* mode) {
#if defined(_WIN32)
  return _wfopen(path.c_str(), pathOf(mode).c_str());
#else
  return std::fopen(path.c_str(), mode);
#endif
}

std::optional<std::string> environmentValue(const std::string& name) {
#if defined(_WIN32)
  const wchar_t* value = _wgetenv(pathOf(name).c_str());
  return value == nullptr ? std::nullopt : std::optional(utf8(value));
#else
  const char* value = std::getenv(name.c_str());
  return value == nullptr ? std::nullopt : std::optional<std::string>(value);
#endif
}

std::filesystem::path programFolder() {
#if defined(_WIN32)
  std::vector<wchar_t> buffer(32768);
  const DWORD length = GetModuleFileNameW(nullptr, buffer.data(), static_cast<DWORD>(buffer.size()));
  return std::filesystem::path(buffer.data(), buffer.data() + length).parent_path();
#elif defined(__APPLE__)
  uint32_t size = 0;
  _NSGetExecutablePath(nullptr, &size);
  std::vector<char> buffer(size + 1);
  if (_NSGetExecutablePath(buffer.data(), &size) != 0) {
    return {};
  }
  std::error_code error;
  return std::filesystem::canonical(buffer.data(), error).parent_path();
#else
  std::error_code error;
  const std::filesystem::path told = std::filesystem::read_symlink("/proc/self/exe", error);
#if defined(__linux__)
  // Where /proc is not mounted: the name that the program was started by, from the folder it was started in.
  const auto* const started = reinterpret_cast<const char*>(getauxval(AT_EXECFN));
  if (told.empty() && started != nullptr) {
    return std::filesystem::canonical(started, error).parent_path();
  }
#endif
  return told.parent_path();
#endif
}

void becomeProgram(const std::filesystem::path& program, char** arguments) {
#if defined(_WIN32)
  std::vector<std::filesystem::path> words;
  for (; *arguments != nullptr; ++arguments) {
    words.push_back(pathOf(*arguments));
  }
  std::vector<const wchar_t*> wide;
  for (const std::filesystem::path& word : words) {
    wide.push_back(word.c_str());
  }
  wide.push_back(nullptr);
  const intptr_t status = _wspawnv(_P_WAIT, program.c_str(), wide.data());
  if (status != -1) {
    std::exit(static_cast<int>(status));
  }
#else
  execv(program.c_str(), arguments);
#endif
}

bool errorStreamIsTerminal() {
#if defined(_WIN32)
  return _isatty(2) != 0;
#else
  return isatty(STDERR_FILENO) != 0;
#endif
}

std::filesystem::path libraryFolder(const void* address) {
#if defined(_WIN32)
  HMODULE module = nullptr;
  if (GetModuleHandleExW(GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS | GET_MODULE_HANDLE_EX_FLAG_UNCHANGED_REFCOUNT,
                         static_cast<LPCWSTR>(address), &module) == 0) {
    return {};
  }
  std::vector<wchar_t> buffer(32768);
  const DWORD length = GetModuleFileNameW(module, buffer.data(), static_cast<DWORD>(buffer.size()));
  return std::filesystem::path(buffer.data(), buffer.data() + length).parent_path();
#else
  Dl_info found{};
  if (dladdr(address, &found) == 0 || found.dli_fname == nullptr) {
    return {};
  }
  std::error_code error;
  return std::filesystem::absolute(pathOf(found.dli_fname), error).parent_path();
#endif
}

}  // namespace metamer::spectral
