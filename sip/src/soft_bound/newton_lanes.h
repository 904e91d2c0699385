// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "metamer/sip/band_weights.h"

namespace metamer::sip {

/// What problems of one soft bound share.
struct SoftBoundSystem {
  int bandCount = 0;
  const double* weights = nullptr;  ///< B x 3, a row a band: A'
  const double* smooth = nullptr;   ///< B x 3, a row a band: the spectrum without clamped bands, from the tristimulus
  double price = 0.0;               ///< of a clamped band: omega
  double slack = 0.0;               ///< added to the diagonal of A K^-1 A'; 0 where A R = c holds exactly
  double relaxation = 0.0;          ///< 1 / slack, or 0
};

/// Some problems side by side: every number of a band, lane by lane.
struct NewtonLanes {
  static constexpr std::size_t kLanes = 8;
  /// No more problems than these need no more lanes than these: wide vectors take longer for each step.
  static constexpr std::size_t kFew = 2;
  template <std::size_t rows>
  using Rows = std::array<double, rows * kLanes>;

  Rows<3> tristimulus;                 ///< c
  Rows<3> held;                        ///< the response that the spectrum is held to: c, + A P where relaxed
  Rows<kConvergedBandCount> prior;     ///< P, where there is one
  Rows<kConvergedBandCount> spectrum;  ///< in: where to start, which is never worsened; out: R
  Rows<kConvergedBandCount> clamp;     ///< out: 0, or the price of the bands that R has below zero
  Rows<1> isUsed;                      ///< 0 for an idle lane, else 1
  Rows<1> rounds;                      ///< out: systems solved
  bool hasPrior = false;
};

/// A band of no more than this part of the spectrum is zero but for rounding, and as good clamped as free: it may
/// change sides for ever.
inline constexpr double kNothing = 1e-12;

/// Newton's method on `count` lanes, 1 ... kLanes (SoftBoundSolver says on what). A lane's result is the same bits
/// whatever lies in the others, and whatever the instruction set: no operation is fused or taken across lanes.
void solveByNewton(const SoftBoundSystem& system, NewtonLanes& lanes, std::size_t count);

}  // namespace metamer::sip
