// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "metamer/sip/recipe.h"
#include "metamer/spectral/input_error.h"

/// Whatever the bytes are, they are a recipe that survives being written and read again, or one short line of error.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace metamer;
  sip::Recipe recipe;
  try {
    recipe = sip::parseRecipe(std::string(reinterpret_cast<const char*>(data), size), "input");
  } catch (const spectral::InputError& error) {
    const std::string message = error.what();
    if (message.find('\n') != std::string::npos || message.size() > 400) {
      std::abort();
    }
    return 0;
  }
  const std::string text = sip::toYaml(recipe);
  if (sip::toYaml(sip::parseRecipe(text, "again")) != text) {
    std::abort();
  }
  return 0;
}
