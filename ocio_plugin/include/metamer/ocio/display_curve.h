// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace metamer::ocio {

/// A curve of a display: sRGB (IEC 61966-2-1), or a power.
struct DisplayCurve {
  std::optional<double> gamma;  ///< empty: sRGB

  /// Light from signal and back, mirrored below zero, going on above 1.
  double decoded(double signal) const;
  double encoded(double light) const;

  /// "sRGB", "Rec.1886" where it is 2.4, else "Gamma 2.2".
  std::string name() const;

  bool operator==(const DisplayCurve&) const = default;
};

/// "sRGB", "Rec.1886" (2.4), "Gamma 2.2" and other numbers from 1 to 4; without regard to case. Empty: none.
std::optional<DisplayCurve> displayCurveNamed(const std::string& name);

}  // namespace metamer::ocio
