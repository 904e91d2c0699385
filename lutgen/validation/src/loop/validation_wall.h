// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "loop/validation_scenes.h"
#include "metamer/sip/pipeline.h"
#include "metamer/validation/validation.h"

namespace metamer::validation {

/// Renders what a stage's calibration takes (the chart under each channel's square, and in the real place: an even
/// sphere of the pipeline's light), solves M, Q and N, and renders the chart inside the driven wall.
WallValidation validateWall(const Chart& chart, const sip::PreparedPipeline& realPlace,
                            const spectral::Observer& camera, const std::array<spectral::DomainSamples, 3>& walls,
                            const ValidationOptions& options);

}  // namespace metamer::validation
