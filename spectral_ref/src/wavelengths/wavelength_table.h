// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "metamer/spectral/spectrum.h"
#include "wavelengths/lanes.h"

namespace metamer::spectral_ref {

/// A density over wavelength, constant within each 1 nm cell, whose inverse distribution function takes one look-up and
/// one comparison.
class WavelengthTable {
 public:
  /// Part of the density that is uniform (the defensive share).
  static constexpr double kDefensive = 0.1;

  /// @param importance  of each cell, on any scale, none negative; all zero gives the uniform density
  explicit WavelengthTable(const spectral::DomainSamples& importance);

  /// F^-1(u), its cell and 1/density in nm. @param u  0 ... 1, not 1
  void sample(float u, float& nm, std::int32_t& cell, float& inverseDensity) const {
    auto index = static_cast<std::size_t>(m_first[static_cast<std::size_t>(u * kSlotsFloat)]);
    // The uniform share alone keeps cells wider than slots: a slot spans two at most.
    index += u >= m_below[index + 1] ? 1U : 0U;
    cell = static_cast<std::int32_t>(index);
    inverseDensity = m_inverse[index];
    nm = kFirstEdgeNm + static_cast<float>(index) + (u - m_below[index]) * inverseDensity;
  }
  /// Per nm.
  float density(std::int32_t cell) const { return 1.0F / m_inverse[static_cast<std::size_t>(cell)]; }
  /// F at the lower edge of a cell; 1 for the one behind the last.
  float below(std::int32_t cell) const { return m_below[static_cast<std::size_t>(cell)]; }

 private:
  static constexpr std::size_t kSlots = 4096;
  static constexpr auto kSlotsFloat = static_cast<float>(kSlots);
  static_assert(kDefensive * static_cast<double>(kSlots) > kCells);

  std::array<std::uint16_t, kSlots> m_first{};  ///< cell that the lower edge of a slot lies in
  std::array<float, kCells + 1> m_below{};
  std::array<float, kCells> m_inverse{};
};

}  // namespace metamer::spectral_ref
