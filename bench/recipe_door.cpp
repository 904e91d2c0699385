// SPDX-License-Identifier: Apache-2.0
// A C door to the transform of any recipe.
#include <memory>

#include "metamer/sip/recipe.h"
#include "metamer/sip/spectral_transform.h"
#include "metamer/spectral/data_library.h"
#include "metamer/spectral/input_error.h"

using namespace metamer;

/// The engine of a recipe's text at `bands`; null where it is refused. Free with metamerEngineClose.
extern "C" void* metamerRecipeEngine(const char* recipe, int bands) {
  try {
    static const auto library = spectral::DataLibrary::openDefault();
    return std::make_unique<sip::SpectralTransform>(sip::resolve(sip::parseRecipe(recipe, "recipe"), library), bands)
        .release();
  } catch (const spectral::InputError&) {
    return nullptr;
  }
}
