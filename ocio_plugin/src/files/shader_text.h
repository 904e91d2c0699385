// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "metamer/ocio/lut_writer.h"
#include "metamer/sip/chromaticity_grid.h"
#include "metamer/sip/device_kernels.h"

namespace metamer::ocio {

/// The text of a shader file: comments with the description and an example of use, the map's kernel, its tables.
std::string shaderText(sip::DeviceDialect dialect, const sip::DeviceTables& tables, const LutDescription& description);

/// The text of a DCTL file: comments with the description and how to use it, the grid.
std::string shaderText(const sip::ChromaticityGrid& grid, const LutDescription& description);

}  // namespace metamer::ocio
