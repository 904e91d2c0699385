// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "metamer/spectral/log_encoding.h"

namespace metamer::ofx {

/// A log curve by tables, both ways, for playback: a parabola a cell, in double precision, off by less than 3e-8 of the
/// light and of the signal (a test holds it to that). Beyond the tables' range, in a cell with a kink, and for what is
/// no number, it is the curve itself.
class SignalTable {
 public:
  explicit SignalTable(spectral::LogEncoding encoding);

  /// Light from signal and signal from light on RGBA pixels in place, alpha left alone.
  void decode(std::span<float> rgba) const;
  void encode(std::span<float> rgba) const;

 private:
  /// constant + rest (linear + rest square), rest running 0 ... 1 over the cell; a constant that is no number: ask the
  /// curve.
  struct Cell {
    double constant;
    double linear;
    double square;
  };
  template <typename Curve>
  static Cell fit(const Curve& curve, double low, double high, double smallest);

  float decodeOne(float signal) const;
  float encodeOne(float light) const;

  spectral::LogEncoding m_encoding;
  std::vector<Cell> m_light;   ///< at equal steps of signal
  std::vector<Cell> m_signal;  ///< at equal steps of the mantissa of |light|, positive light first
};

}  // namespace metamer::ofx
