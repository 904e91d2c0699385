// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "effects/catalogue.h"
#include "effects/effect.h"

namespace metamer::ofx {

/// The effect that edits skin by what it is made of. @param catalogue  outlives it
std::unique_ptr<Effect> makeSkin(const Catalogue& catalogue);

}  // namespace metamer::ofx
