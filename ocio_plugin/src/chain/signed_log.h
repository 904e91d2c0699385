// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

#include "metamer/ocio/exposure_invariant_chain.h"

namespace metamer::ocio {

/// Logarithm to base 2 of either sign: stops above kChainStops below 0.18, which has kSignedLogToe, with a straight toe
/// from there through zero. Odd.
double signedLog(double value);
double signedExponential(double log);

/// Where the toe ends, and the most that is kept.
inline constexpr double kSignedLogToe = std::numbers::log2e;
inline constexpr double kMostSignedLog = 2.0 * kChainStops + kSignedLogToe;

/// The third channel's signedLog(), brought from -kMostSignedLog ... kMostSignedLog to 0 ... 1, as OCIO operators: two
/// camera logs, one a side, of which each leaves to the other what is not its own.
OCIO::GroupTransformRcPtr signedLogOfThird();

/// signedExponential() of all three channels.
OCIO::GroupTransformRcPtr signedExponentialOfAll();

}  // namespace metamer::ocio
