// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "metamer/sip/recipe.h"

namespace metamer::lutgen {

/// The playground's page, to stand within a report: it begins with the recipe's lights, first output gel and
/// adaptation, as far as they are measured tables by name.
/// @throws spectral::InputError where this metamer was installed without it
std::string livePage(const sip::Recipe& recipe);

}  // namespace metamer::lutgen
