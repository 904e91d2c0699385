// SPDX-License-Identifier: Apache-2.0
#include "pixels/signal_table.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "metamer/spectral/log_pieces.h"
#include "pixels/device_words.h"

namespace metamer::ofx {
namespace {

constexpr double kPerRest = 1.0 / (1U << SignalTable::kRestBits);

/// What a cell may be off by, of its value.
constexpr double kTolerance = 3e-8;

}  // namespace

template <typename Curve>
SignalTable::Cell SignalTable::fit(const Curve& curve, double low, double high, double smallest) {
  const auto at = [&](double rest) { return curve(low + rest * (high - low)); };
  const double first = at(0.0);
  const double bend = 2.0 * (first + at(1.0)) - 4.0 * at(0.5);
  const Cell cell{first, at(1.0) - first - bend, bend};
  for (const double rest : {0.125, 0.25, 0.375, 0.625, 0.75, 0.875}) {
    const double error = cell.constant + rest * (cell.linear + rest * cell.square) - at(rest);
    if (!(std::abs(error) <= kTolerance * std::max(std::abs(at(rest)), smallest))) {
      return {std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0};
    }
  }
  return cell;
}

SignalTable::SignalTable(spectral::LogEncoding encoding) : m_encoding(encoding) {
  for (int i = 0; i < kSignalCells; ++i) {
    const double low = kLeastSignal + i / kCellsPerSignal;
    m_light.push_back(
        fit([&](double signal) { return spectral::decode(encoding, signal); }, low, low + 1.0 / kCellsPerSignal, 0.01));
  }
  for (const double sign : {1.0, -1.0}) {
    for (std::size_t i = 0; i < kCellsASign; ++i) {
      const double octave = std::ldexp(sign, kLeastExponent + static_cast<int>(i >> kCellBits));
      const double low = 1.0 + static_cast<double>(i & ((1U << kCellBits) - 1U)) / (1U << kCellBits);
      m_signal.push_back(fit([&](double light) { return spectral::encode(encoding, light); }, octave * low,
                             octave * (low + 1.0 / (1U << kCellBits)), 0.1));
    }
  }
}

float SignalTable::decodeOne(float signal) const {
  const double position = (static_cast<double>(signal) - kLeastSignal) * kCellsPerSignal;
  if (position >= 0.0 && position < kSignalCells) {
    const auto index = static_cast<std::size_t>(position);
    const Cell& cell = m_light[index];
    const double rest = position - static_cast<double>(index);
    const double light = cell.constant + rest * (cell.linear + rest * cell.square);
    if (light == light) {
      return static_cast<float>(light);
    }
  }
  return static_cast<float>(spectral::decode(m_encoding, signal));
}

float SignalTable::encodeOne(float light) const {
  const auto bits = std::bit_cast<std::uint32_t>(light);
  const std::uint32_t magnitude = bits & 0x7fffffffU;
  const std::uint32_t index = (magnitude >> kRestBits) - kFirstCell;  // wraps round below the least
  if (index < kCellsASign) {
    const Cell& cell = m_signal[index + ((bits >> 31U) != 0 ? kCellsASign : 0)];
    const double rest = static_cast<double>(magnitude & ((1U << kRestBits) - 1U)) * kPerRest;
    const double signal = cell.constant + rest * (cell.linear + rest * cell.square);
    if (signal == signal) {
      return static_cast<float>(signal);
    }
  }
  return static_cast<float>(spectral::encode(m_encoding, light));
}

void SignalTable::decode(std::span<float> rgba) const {
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    for (std::size_t k = i; k < i + 3; ++k) {
      rgba[k] = decodeOne(rgba[k]);
    }
  }
}

void SignalTable::encode(std::span<float> rgba) const {
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    for (std::size_t k = i; k < i + 3; ++k) {
      rgba[k] = encodeOne(rgba[k]);
    }
  }
}

sip::DeviceTables SignalTable::deviceTables() const {
  sip::DeviceTables tables;
  appendPieces(tables.cells, spectral::piecesOf(m_encoding));
  for (const std::vector<Cell>* const cells : {&m_light, &m_signal}) {
    for (const Cell& cell : *cells) {
      appendDouble(tables.cells, cell.constant);
      appendDouble(tables.cells, cell.linear);
      appendDouble(tables.cells, cell.square);
    }
  }
  return tables;
}

}  // namespace metamer::ofx
