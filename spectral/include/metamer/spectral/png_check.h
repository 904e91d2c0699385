// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace metamer::spectral {

/// Refuses a PNG that is cut short or damaged before its library sees it, which prints to stderr by itself. Other files
/// pass.
/// @throws InputError naming the byte
void refuseBrokenPng(const std::string& file);

}  // namespace metamer::spectral
