// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "metamer/skin/layered_albedo.h"

namespace metamer::skin {

/// @throws spectral::InputError where a field is outside what LayerOptics says
void requireLayers(const LayerOptics& layers);

}  // namespace metamer::skin
