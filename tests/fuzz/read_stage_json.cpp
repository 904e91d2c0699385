// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <string>

#include "effects/stage_file.h"
#include "refusal.h"

/// Whatever the bytes are, they are finite matrices for the plug-in, or one short line of error.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace metamer;
  try {
    const ofx::Stage stage = ofx::parseStageFile(std::string(reinterpret_cast<const char*>(data), size), "input");
    require(stage.m.allFinite() && stage.q.allFinite() && stage.n.allFinite() && stage.offset.allFinite());
  } catch (const spectral::InputError& error) {
    checkRefusal(error);
  }
  return 0;
}
