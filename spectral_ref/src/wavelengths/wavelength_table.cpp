// SPDX-License-Identifier: Apache-2.0
#include "wavelengths/wavelength_table.h"

#include <algorithm>

namespace metamer::spectral_ref {

WavelengthTable::WavelengthTable(const spectral::DomainSamples& importance) {
  const double total = importance.sum();
  double below = 0;
  for (int cell = 0; cell < kCells; ++cell) {
    const auto i = static_cast<std::size_t>(cell);
    const double share = total > 0 ? importance[cell] / total : 1.0 / kCells;
    m_below[i] = static_cast<float>(below);
    below += (1.0 - kDefensive) * share + kDefensive / kCells;
  }
  m_below.back() = 1.0F;
  // Densities are those of the rounded distribution function: what is sampled is what is stated.
  for (std::size_t i = 0; i < kCells; ++i) {
    m_inverse[i] = 1.0F / (m_below[i + 1] - m_below[i]);
  }
  std::size_t cell = 0;
  for (std::size_t slot = 0; slot < kSlots; ++slot) {
    const float u = static_cast<float>(slot) / kSlotsFloat;
    while (m_below[cell + 1] <= u) {
      ++cell;
    }
    m_first[slot] = static_cast<std::uint16_t>(cell);
  }
}

}  // namespace metamer::spectral_ref
