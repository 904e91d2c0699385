// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

// All that differs between operating systems stands behind this file.
namespace metamer::spectral {

/// Folder of the running program. Empty where the system does not tell.
std::filesystem::path programFolder();

}  // namespace metamer::spectral
