// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "metamer/spectral/data_library.h"

namespace metamer::lutgen {

/// The data library as lutgen's commands open it: spectral OpenEXR pictures are spectral files.
/// @throws InputError: see DataLibrary::openDefault
spectral::DataLibrary openLibrary();

}  // namespace metamer::lutgen
