// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "chain/chromaticity_plane.h"
#include "chain/chromaticity_probe.h"
#include "chain/lattice_fit.h"

namespace metamer::ocio {

/// Sets the nodes of a lattice to the transform's values there.
void sampleNodes(PlaneLattice& lattice, const ChromaticityPlane& plane, const ChromaticityProbe& probe);

/// A place where a table is judged.
struct TableSample {
  LatticeSample fit;
  ChromaticityProbe::Answer exact;
  double area = 0;  ///< in CIE xy: its share among the error protocol's probes
};

/// Samples spread over a lattice's cells, and close to the border of what reflectances can make.
std::vector<TableSample> takeSamples(const PlaneLattice& lattice, const ChromaticityProbe& probe);

}  // namespace metamer::ocio
