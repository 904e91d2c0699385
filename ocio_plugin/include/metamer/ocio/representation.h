// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include <string>

#include "metamer/sip/spectral_transform.h"

namespace metamer::ocio {

namespace OCIO = OCIO_NAMESPACE;

/// How a spectral transform is put into OCIO operators, from the cheapest on.
enum class Representation {
  Identity,  ///< nothing: both pipelines are the same
  Matrix,    ///< the linear piece: exact for the smooth scene where no band is clamped and nothing limited
  LogCube,   ///< a 3-D table over log-encoded RGB, tetrahedral; clips what the log signal cannot hold
  ExposureInvariantChain,  ///< see exposure_invariant_chain.h
  HomogeneousMap,          ///< the engine's own table and kernel, in shader files; no OCIO operators
};

/// "identity", "matrix", "log cube", "exposure-invariant chain", "homogeneous map".
std::string nameOf(Representation representation);

/// A transform as OCIO operators on the engine's linear RGB. Identity is an empty group, which OCIO knows to be a
/// no-op.
/// @param representation  any but LogCube, which works on a signal, and HomogeneousMap, which no operators hold
/// @param spec            what `transform` was made from
/// @param size            nodes along a side of a table, kSmallestTable ... kLargestTable (log_cube.h)
/// @throws spectral::InputError for these, and for a chain of another size
OCIO::GroupTransformRcPtr engineOperators(Representation representation, const sip::TransformSpec& spec,
                                          const sip::SpectralTransform& transform, int size);

}  // namespace metamer::ocio
