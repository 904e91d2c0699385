// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "effects/catalogue.h"
#include "effects/effect.h"

namespace metamer::ofx {

/// The effect that puts a picture under another light, behind another filter, before another observer.
std::unique_ptr<Effect> makeSpectralTransfer(const Catalogue& catalogue);

}  // namespace metamer::ofx
