// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include "metamer/ocio/signal.h"

namespace metamer::ocio {

/// Fewer nodes a side are better off without a curve: they lie two stops apart, and a straight line from one to the
/// next misses the toe's bend by more than the toe's few nodes cost.
inline constexpr int kShaperCurveFromSize = 17;
/// Entries where nothing else is asked for.
inline constexpr int kShaperCurveEntries = 4096;

/// The curve in front of a fitted table: from a signal to the table's axes, 0 ... 1 both.
///
/// A log signal has a straight toe, in which all dark colours share the cells round black. The curve is a logarithm
/// down to four stops below the exposures that the table is for, so that cells are as many for a stop there as above.
/// @param size        nodes along a side of the table
/// @param lowestStop  round Y = 0.18
/// @param entries     2 or more
OCIO::Lut1DTransformRcPtr shaperCurve(const Signal& signal, int size, double lowestStop, int entries);

/// The signal of a table's axes: `signal` seen through a curve.
Signal behindShaperCurve(const Signal& signal, const OCIO::ConstTransformRcPtr& shaperCurve);

/// The curve that a group starts with, where a table behind it may take 0 ... 1 for granted: it rises from 0 to 1, and
/// more follows. Null where there is none.
OCIO::ConstLut1DTransformRcPtr leadingShaperCurve(const OCIO::ConstGroupTransformRcPtr& group);

}  // namespace metamer::ocio
