// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <string>

#include "metamer/sip/recipe.h"
#include "refusal.h"

/// Whatever the bytes are, they are a recipe that survives being written and read again, or one short line of error.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace metamer;
  sip::Recipe recipe;
  try {
    recipe = sip::parseRecipe(std::string(reinterpret_cast<const char*>(data), size), "input");
  } catch (const spectral::InputError& error) {
    checkRefusal(error);
    return 0;
  }
  const std::string text = sip::toYaml(recipe);
  require(sip::toYaml(sip::parseRecipe(text, "again")) == text);
  return 0;
}
