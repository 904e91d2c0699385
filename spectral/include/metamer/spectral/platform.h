// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>

// All that differs between operating systems stands behind this file.
namespace metamer::spectral {

/// std::fopen for any name. Null with errno where the file cannot be opened.
std::FILE* openFile(const std::filesystem::path& path, const char* mode);

/// A variable of the environment as UTF-8. Empty where it is not set.
std::optional<std::string> environmentValue(const std::string& name);

/// Folder of the running program. Empty where the system does not tell.
std::filesystem::path programFolder();

/// Runs another program in the place of this one, with the same streams. Returns only where that cannot be done.
/// @param arguments  its arguments from its own name on, then null; UTF-8
void becomeProgram(const std::filesystem::path& program, char** arguments);

/// Whether what is written to stderr is read by a person as it comes.
bool errorStreamIsTerminal();

/// Folder of the program or shared library that holds the object or function at this address; absolute. Empty where
/// the system does not tell.
std::filesystem::path libraryFolder(const void* address);

}  // namespace metamer::spectral
