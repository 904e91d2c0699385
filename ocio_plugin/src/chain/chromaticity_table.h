// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "chain/chromaticity_plane.h"
#include "chain/chromaticity_ticks.h"
#include "chain/lattice_fit.h"

namespace metamer::ocio {

/// A spectral transform over the plane of chromaticity. A node holds the output's (a, b), and the output's amount less
/// the input's, in stops. What lies between the nodes is exact where the transform is its unconstrained matrix.
struct ChromaticityTable {
  ChromaticityPlane plane;
  PlaneLattice lattice;
};

/// Chooses the plane by how far tables on it err, crowds the nodes where the transform bends, solves their values, and
/// moves the nodes on toward what still errs.
/// @param spec    what `transform` was made from
/// @param size    nodes along a side
/// @param fitted  false: the transform's own values at the nodes
ChromaticityTable buildChromaticityTable(const sip::TransformSpec& spec, const sip::SpectralTransform& transform,
                                         int size, bool fitted);

}  // namespace metamer::ocio
