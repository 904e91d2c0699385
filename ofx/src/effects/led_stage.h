// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "effects/effect.h"

namespace metamer::ofx {

/// The effect that applies what `lutgen stage solve` found for an LED stage.
std::unique_ptr<Effect> makeLedStage();

}  // namespace metamer::ofx
