// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "metamer/spectral/log_encoding.h"
#include "pixels/device_form.h"

namespace metamer::ofx {

/// A log curve by tables, both ways, for playback: a parabola a cell, in double precision, off by less than 3e-8 of the
/// light and of the signal (a test holds it to that). Beyond the tables' range, in a cell with a kink, and for what is
/// no number, it is the curve itself.
class SignalTable {
 public:
  /// Signals: what cameras write, with room for what a transform makes of it.
  static constexpr double kLeastSignal = -0.5;
  static constexpr int kSignalCells = 1 << 12;
  static constexpr double kCellsPerSignal = kSignalCells / 2.0;
  /// Light: |x| from 2^-20 to 2^20, each octave in as many cells. A cell is the top bits of a float, less the first's.
  static constexpr int kLeastExponent = -20;
  static constexpr int kMostExponent = 20;
  static constexpr int kCellBits = 6;
  static constexpr int kRestBits = 23 - kCellBits;
  static constexpr std::uint32_t kFirstCell = (127U + kLeastExponent) << kCellBits;
  static constexpr std::size_t kCellsASign = static_cast<std::size_t>(kMostExponent - kLeastExponent) << kCellBits;

  explicit SignalTable(spectral::LogEncoding encoding);

  /// Light from signal and signal from light on RGBA pixels in place, alpha left alone.
  void decode(std::span<float> rgba) const;
  void encode(std::span<float> rgba) const;

  /// The same for kernels of other devices, in doubles: the curve's pieces, the cells of light, those of signal.
  const ResidentTables& resident() const { return m_resident; }

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
  sip::DeviceTables deviceTables() const;

  spectral::LogEncoding m_encoding;
  std::vector<Cell> m_light;   ///< at equal steps of signal
  std::vector<Cell> m_signal;  ///< at equal steps of the mantissa of |light|, positive light first
  ResidentTables m_resident{[this] { return deviceTables(); }};
};

}  // namespace metamer::ofx
