// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <string>

#include "metamer/spectral_ref/scene_reader.h"
#include "refusal.h"

/// Whatever the bytes are, they are a scene whose spectra are finite, or one short line of error. Files that a scene
/// names are looked for where there are none.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace metamer;
  static const auto library = spectral::DataLibrary::openDefault();
  try {
    const auto scene = spectral_ref::parseScene(std::string(reinterpret_cast<const char*>(data), size), "input",
                                                "/nonexistent", library);
    for (const spectral::DomainSamples& samples : scene.spectra) {
      require(samples.allFinite());
    }
  } catch (const spectral::InputError& error) {
    checkRefusal(error);
  }
  return 0;
}
