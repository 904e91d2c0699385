// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "metamer/spectral/formatted.h"

namespace metamer::lutgen {

/// A place on the scale, and what it means to an eye.
struct ErrorMark {
  double value = 0.0;  ///< CIEDE2000
  std::string words;
};

/// A logarithmic scale of colour differences, from 0.01, which nobody sees, to the largest that is there.
class ErrorScale {
 public:
  static constexpr double kLowest = 0.01;

  /// Ends at the first of 1, 3, 10, 30, 100 that `largest` does not pass.
  explicit ErrorScale(double largest = 1.0) {
    for (const double end : {1.0, 3.0, 10.0, 30.0, 100.0}) {
      m_highest = end;
      if (largest <= end) {
        break;
      }
    }
  }

  double highest() const { return m_highest; }
  /// Of the way up, 0 ... 1; kLowest and less at 0, the end and more at 1. What is no number is at 1.
  double share(double deltaE) const {
    return std::isnan(deltaE)  ? 1.0
           : deltaE <= kLowest ? 0.0
                               : std::min(1.0, std::log(deltaE / kLowest) / std::log(m_highest / kLowest));
  }
  /// The difference at a share of the way up.
  double value(double share) const { return kLowest * std::pow(m_highest / kLowest, share); }
  /// What to write beside it.
  std::vector<ErrorMark> marks() const {
    std::vector<ErrorMark> marks;
    for (const auto& [value, meaning] : {std::pair(0.01, "and less"),
                                         {0.1, "nobody sees it"},
                                         {1.0, "seen side by side"},
                                         {3.0, "plain to everybody"},
                                         {10.0, "another colour"},
                                         {30.0, ""},
                                         {100.0, "and more"}}) {
      if (value <= m_highest) {
        marks.push_back({value, spectral::formatted("%g  %s", value, meaning)});
      }
    }
    return marks;
  }

 private:
  double m_highest = 1.0;
};

}  // namespace metamer::lutgen
