// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace metamer::lutgen {

/// A curve of a display: sRGB (IEC 61966-2-1), or a power.
struct DisplayCurve {
  std::optional<double> gamma;  ///< empty: sRGB

  /// Light from signal and back, mirrored below zero, going on above 1.
  double decoded(double signal) const;
  double encoded(double light) const;
};

/// "sRGB", "Rec.1886" or "Rec.709 video" (2.4), "Gamma 2.2" and other numbers; without regard to case. Empty: none.
std::optional<DisplayCurve> displayCurveNamed(const std::string& name);

}  // namespace metamer::lutgen
