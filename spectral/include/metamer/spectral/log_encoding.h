// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace metamer::spectral {

/// A camera's or ACES's log curve between scene-linear light and a 0 ... 1 signal (10-bit code / 1023 where the
/// maker defines it in codes). Each is defined, continuous and strictly rising on the whole real line.
enum class LogEncoding { AcesCct, LogC3, LogC4, SLog3, VLog, Log3G10, CanonLog2, CanonLog3, DaVinciIntermediate };

/// All, in the order above.
const std::vector<LogEncoding>& allLogEncodings();
/// "ACEScct", "LogC3" (EI 800), "LogC4", "S-Log3", "V-Log", "Log3G10", "Canon Log 2", "Canon Log 3",
/// "DaVinci Intermediate".
std::string nameOf(LogEncoding encoding);

/// Signal from scene-linear light (0.18 = mid grey). Sources stand beside each curve.
double encode(LogEncoding encoding, double linear);
/// Scene-linear light from signal.
double decode(LogEncoding encoding, double signal);

}  // namespace metamer::spectral
