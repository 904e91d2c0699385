// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

// All that differs between operating systems stands behind this file.
namespace metamer::spectral {

/// Folder of the running program. Empty where the system does not tell.
std::filesystem::path programFolder();

/// Whether what is written to stderr is read by a person as it comes.
bool errorStreamIsTerminal();

}  // namespace metamer::spectral
