// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "metamer/spectral/log_encoding.h"

namespace metamer::spectral {

/// A log curve as plain numbers, for kernels on other devices: a logarithm above a line above a logarithm, of which
/// either of the lower two may be missing. The same function as encode() and decode() but for the last bits of doubles.
struct LogPieces {
  /// signal = scale log10(gain light + shift) + offset.
  struct Logarithm {
    double gain;
    double shift;
    double scale;
    double offset;
  };
  Logarithm above;
  Logarithm below;
  double lightAbove;   ///< from here on the logarithm above
  double signalAbove;  ///< the same as a signal
  double lightBelow;   ///< what is less is the logarithm below; minus infinity: there is none
  double signalBelow;
  double slope;  ///< between them signal = signalAbove + slope (light - lightAbove)
};

LogPieces piecesOf(LogEncoding encoding);

}  // namespace metamer::spectral
