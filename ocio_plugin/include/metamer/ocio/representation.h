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
};

/// "identity", "matrix", "log cube", "exposure-invariant chain".
std::string nameOf(Representation representation);

inline constexpr int kSmallestTable = 3;
inline constexpr int kLargestTable = 129;

/// A transform as OCIO operators on the engine's linear RGB. Identity is an empty group, which OCIO knows to be a
/// no-op.
/// @param representation  any but LogCube, which works on a signal
/// @param spec            what `transform` was made from
/// @param size            nodes along a side of a table
OCIO::GroupTransformRcPtr engineOperators(Representation representation, const sip::TransformSpec& spec,
                                          const sip::SpectralTransform& transform, int size);

/// A signal between 0 and 1 that stands for the engine's linear RGB.
struct Signal {
  OCIO::ConstTransformRcPtr toEngine;
  OCIO::ConstTransformRcPtr fromEngine;
};

struct LogCubeOptions {
  int size = 33;       ///< nodes along a side, kSmallestTable ... kLargestTable
  bool fitted = true;  ///< nodes solved for least error; false: the transform's own values there
  /// Exposures it is fitted to: stops round Y = 0.18, as the error protocol counts them.
  double lowestStop = -7;
  double highestStop = 7;
  /// Whether nodes may be signals below 0, which stand for what leaves the gamut. False for formats of whole numbers.
  bool belowZero = true;
  /// Curve in front of the table, from the signal to the table's axes. Null: the axes are the signal's.
  OCIO::ConstTransformRcPtr prelut = nullptr;
};

/// The table of a LogCube: signal in, signal out, over 0 ... 1 on each axis, to be looked up by tetrahedra. Where there
/// is a prelut, what comes out of it goes into the table.
///
/// A fitted table's nodes are no values of the transform: what lies between them is as near to it as their number
/// allows (docs/representations.md). Its neutral nodes are exact, but for the one at black or next below, which keeps
/// black black. A sampled table has the transform's own values, however far below 0 or above 1 they lie; a fitted one
/// lies between the lowest and the highest that real colours become.
OCIO::Lut3DTransformRcPtr logCube(const sip::SpectralTransform& transform, const Signal& signal,
                                  const LogCubeOptions& options = {});

}  // namespace metamer::ocio
