// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace metamer::sip {

/// Exposures that anything is judged at: stops below and above Y = 0.18.
inline constexpr int kMostStops = 24;

/// Probes of one kind.
inline constexpr int kMostProbes = 1'000'000;

}  // namespace metamer::sip
