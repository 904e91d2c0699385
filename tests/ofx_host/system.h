// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

// What differs between the systems that the bare host runs on.
namespace bare_host {

/// A library that is loaded for as long as this lives.
class LoadedLibrary {
 public:
  /// @throws std::runtime_error in the system's words
  explicit LoadedLibrary(const std::filesystem::path& file);
  ~LoadedLibrary();
  LoadedLibrary(const LoadedLibrary&) = delete;
  LoadedLibrary& operator=(const LoadedLibrary&) = delete;

  /// @throws std::runtime_error where it does not export it
  void* symbol(const char* name) const;

 private:
  void* m_handle;
};

/// Where METAMER_OFX_LIBRARY points to; empty where it is not set.
std::filesystem::path libraryOfEnvironment();

/// As the plug-in's text parameters take it: UTF-8.
std::string textOf(const std::filesystem::path& path);
std::filesystem::path pathOf(const std::string& text);

/// Memory that the process holds now, bytes.
std::size_t residentBytes();

/// Sanitizers hold freed memory back.
bool residentMemoryIsMeasurable();

}  // namespace bare_host
