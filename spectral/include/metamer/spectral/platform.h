// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

// All that differs between operating systems stands behind this file.
namespace metamer::spectral {

/// Folder of the running program. Empty where the system does not tell.
std::filesystem::path programFolder();

/// Runs another program in the place of this one, with the same streams. Returns only where that cannot be done.
/// @param arguments  its arguments from its own name on, then null
void becomeProgram(const std::filesystem::path& program, char** arguments);

/// Whether what is written to stderr is read by a person as it comes.
bool errorStreamIsTerminal();

/// Folder of the program or shared library that holds the object or function at this address; absolute. Empty where
/// the system does not tell.
std::filesystem::path libraryFolder(const void* address);

}  // namespace metamer::spectral
