// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "window_forms.h"

/// One thread of a kernel of the plug-in's Metal text, compiled as C++.
/// @param pointers  of the arguments that are buffers
void runMetalThread(const std::string& kernel, const KeptArguments& arguments,
                    const std::vector<unsigned char*>& pointers, unsigned int x, unsigned int y);
