// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "metamer/ocio/certificate.h"
#include "metamer/ocio/lut_writer.h"
#include "metamer/sip/error_protocol.h"

namespace metamer::ocio {

/// One way of putting a transform into a format.
struct Rung {
  Representation representation = Representation::Identity;
  int size = 0;  ///< nodes along a side, 0 where there is no table
};

/// All that a format can hold, from the cheapest to apply on. A table file costs its nodes, whatever fills them.
/// @param largest  the most nodes along a side
std::vector<Rung> rungsOf(const LutFormat::Content content, bool holdsChain, int largest);

/// Climbs until the 99th percentile is within a tolerance.
/// @param measure  the error of a rung
/// @return what was tried; the last one holds
/// @throws spectral::InputError where none does, with the best
CertifiedChoice climb(const std::vector<Rung>& rungs, double tolerance,
                      const std::function<sip::ErrorProtocol::Report(const Rung&)>& measure);

}  // namespace metamer::ocio
