// SPDX-License-Identifier: Apache-2.0
#include "operators/signal_probes.h"

#include <algorithm>
#include <cmath>

namespace metamer::ocio {
namespace {

constexpr int kSignalStops = 7;

}  // namespace

sip::ErrorProtocol::Options signalProbes(spectral::LogEncoding encoding) {
  const double stops = std::log2(spectral::decode(encoding, 1.0) / 0.18);
  sip::ErrorProtocol::Options probes;
  probes.insideGamutOnly = true;
  probes.lowestStop = -kSignalStops;
  probes.highestStop = std::min(kSignalStops, static_cast<int>(std::floor(stops)) - 2);
  return probes;
}

}  // namespace metamer::ocio
