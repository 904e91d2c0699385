// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "metamer/sip/comparison.h"
#include "metamer/sip/spectral_transform.h"
#include "report/known_surfaces.h"
#include "report/screen.h"

namespace metamer::lutgen {

/// Something of the page that is drawn, and what is written under it.
struct Chart {
  std::string drawing;  ///< inline SVG
  std::string caption;
};

/// The lights with their filters, the filters, the observers.
std::vector<Chart> spectraCharts(const sip::TransformSpec& spec, const Screen& screen);

/// Where chromaticities go, CIE 1976 u'v', beside where plain adaptation moves them.
Chart fieldChart(const sip::TransformSpec& spec, const sip::SpectralTransform& transform, const Screen& screen);

/// The largest difference over hue, round the white, and exposure, in logarithmic steps.
/// @param label  of what was compared with the engine
Chart errorChart(const sip::Comparison& comparison, const spectral::RgbSpace& space, const Screen& screen,
                 const std::string& label);

/// Patches: as shot above; engine, truth and plain adaptation below.
Chart surfaceChart(const SurfaceGroup& group, const Screen& screen);

}  // namespace metamer::lutgen
