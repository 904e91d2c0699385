// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "metamer/stage/stage_description.h"
#include "metamer/stage/stage_geometry.h"
#include "refusal.h"

/// Whatever the bytes are, they are a stage whose numbers can be solved with, or one short line of error.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace metamer;
  try {
    const auto stage = stage::parseStage(std::string(reinterpret_cast<const char*>(data), size), "input", "folder");
    require(std::isfinite(stage::calibrationSquareBeta(stage.widthM, stage.heightM, stage.distanceM)));
    require(stage.blackLevel.allFinite() && stage.facing.norm() > 0);
    require(!stage.environmentWhite || stage.environmentWhite->allFinite());
    require(stage.skinWeight >= 0 && stage.largestCondition.value_or(1) >= 1);
    require(!stage.noise || (stage.noise->relative >= 0 && stage.noise->floor >= 0));
    require(stage.layout.columns >= 1 && stage.layout.rows >= 1);
    for (std::size_t k = 0; k < 3; ++k) {
      const stage::StagePrimary& primary = stage.primaries[k];
      require(stage.spectra || (primary.value ? primary.value->allFinite() : !primary.file.empty()));
      require(stage.spectra || stage.charts[k].corners.empty() || stage.charts[k].corners.size() == 4);
    }
  } catch (const spectral::InputError& error) {
    checkRefusal(error);
  }
  return 0;
}
