// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "metamer/sip/recipe.h"

namespace metamer::ocio {

/// A recipe between two lights. What is tested with it does not depend on the scene; this one takes half the time.
inline sip::Recipe recipeOf(const std::string& from, const std::string& to, const std::string& space = "ACEScg") {
  sip::Recipe recipe;
  recipe.name = "look";
  recipe.space = space;
  recipe.input.illuminant = from;
  recipe.output.illuminant = to;
  recipe.scene.kind = sip::ReferenceScene::Kind::Smooth;
  return recipe;
}

}  // namespace metamer::ocio
