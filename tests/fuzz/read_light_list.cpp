// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "refusal.h"
#include "stage_pictures/light_list.h"

/// Whatever the bytes are, they are lights each with a direction, or one short line of error.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace metamer;
  try {
    const auto lights = lutgen::parseLights(std::string(reinterpret_cast<const char*>(data), size), "input");
    require(!lights.empty());
    for (const lutgen::PositionedLight& light : lights) {
      require(std::abs(light.position.stableNormalized().norm() - 1) < 1e-9);
    }
  } catch (const spectral::InputError& error) {
    checkRefusal(error);
  }
  return 0;
}
