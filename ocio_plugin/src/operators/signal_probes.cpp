// SPDX-License-Identifier: Apache-2.0
#include "operators/signal_probes.h"

#include <algorithm>
#include <cmath>

namespace metamer::ocio {
namespace {

constexpr int kSignalStops = 7;
/// 18 % grey less five stops is a 177th of white: a code of 13 in 255.
constexpr int kDisplayStops = 5;

}  // namespace

sip::ErrorProtocol::Options signalProbes(const Shaper& shaper) {
  const double end = decode(shaper, 1.0);
  const double stops = std::log2(end / 0.18);
  sip::ErrorProtocol::Options probes;
  probes.insideGamutOnly = true;
  if (isDisplay(shaper)) {
    probes.lowestStop = -kDisplayStops;
    probes.highestStop = static_cast<int>(std::floor(stops));
    probes.largestComponent = end;
    return probes;
  }
  probes.lowestStop = -kSignalStops;
  probes.highestStop = std::min(kSignalStops, static_cast<int>(std::floor(stops)) - 2);
  return probes;
}

}  // namespace metamer::ocio
