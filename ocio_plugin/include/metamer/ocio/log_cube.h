// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include "metamer/ocio/signal.h"
#include "metamer/sip/spectral_transform.h"

namespace metamer::ocio {

/// Nodes along a side of any table.
inline constexpr int kSmallestTable = 3;
inline constexpr int kLargestTable = 129;

struct LogCubeOptions {
  int size = 33;       ///< nodes along a side, kSmallestTable ... kLargestTable
  bool fitted = true;  ///< nodes solved for least error; false: the transform's own values there
  /// Exposures it is fitted to: stops round Y = 0.18, as the error protocol counts them, rising.
  double lowestStop = -7;
  double highestStop = 7;
  /// Whether nodes may be signals below 0, which stand for what leaves the gamut. False for formats of whole numbers.
  bool belowZero = true;
  /// Curve in front of the table, from the signal to the table's axes. Null: the axes are the signal's.
  OCIO::ConstTransformRcPtr shaperCurve = nullptr;
};

/// The table of a LogCube: signal in, signal out, over 0 ... 1 on each axis, to be looked up by tetrahedra. Where there
/// is a 1-D shaper, what comes out of it goes into the table.
///
/// A fitted table's nodes are no values of the transform: what lies between them is as near to it as their number
/// allows (docs/representations.md). Its neutral nodes are exact, but for the one at black or next below, which keeps
/// black black. A sampled table has the transform's own values, however far below 0 or above 1 they lie; a fitted one
/// lies between the lowest and the highest that real colours become.
/// @throws spectral::InputError where the size or the stops are out of their range
OCIO::Lut3DTransformRcPtr logCube(const sip::SpectralTransform& transform, const Signal& signal,
                                  const LogCubeOptions& options = {});

}  // namespace metamer::ocio
