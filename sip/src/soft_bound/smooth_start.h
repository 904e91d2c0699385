// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace metamer::sip {

/// A spectrum from its tristimulus where no band is clamped, and whether that is the answer.
struct SmoothStart {
  const double* unclamped = nullptr;  ///< three columns of bandCount values (SoftBoundSolver::unclamped)
  int bandCount = 0;

  /// `unclamped * c + P`.
  /// @param tristimulus  c, three values
  /// @param prior        P, bandCount values, or null for zero
  /// @param spectrum     out: bandCount values
  /// @return whether none of them is below zero by more than rounding
  bool operator()(const double* tristimulus, const double* prior, double* spectrum) const;
};

}  // namespace metamer::sip
