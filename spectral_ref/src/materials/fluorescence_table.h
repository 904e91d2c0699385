// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/geometry.h"
#include "metamer/spectral/reradiation.h"
#include "wavelengths/lanes.h"

namespace metamer::spectral_ref {

/// How a fluorescent surface shifts wavelengths, ready to draw excitations from: in proportion to its re-radiation
/// times what the scene's lights have there, a part of that even, so that no excitation is left out.
///
/// A path goes from the camera to the light: it arrives with emissions and leaves with excitations.
class FluorescenceTable {
 public:
  /// @param light  the scene's lights on any scale; 0 counts all excitations alike
  FluorescenceTable(const spectral::FluorescentSamples& surface, const spectral::ExcitationSamples& light);

  /// What shifted light is worth at an emission: the sum of re-radiation times the light. @param cell  -80 ... 400
  float shifted(std::int32_t cell) const { return m_below[end(cell)]; }
  /// The light at a wavelength, 1 on average.
  float light(std::int32_t cell) const { return m_light[index(cell)]; }

  /// An excitation and its re-radiation over its density.
  struct Excitation {
    std::int32_t cell;
    float weight;
  };
  /// @param u  0 ... 1, not 1. Only where shifted(cell) is above 0
  Excitation sample(std::int32_t cell, float u) const {
    const float* row = m_below.data() + start(cell);
    const float* last = m_below.data() + end(cell);
    // The last excitation with a part of the sum: rounding leaves u times it at most at the end.
    const float wanted = std::min(u * *last, std::nextafter(*last, 0.0F));
    const auto found = static_cast<std::int32_t>(std::upper_bound(row, last, wanted) - row) - 1;
    return {found - kUltravioletCells, *last / m_light[static_cast<std::size_t>(found)]};
  }

  /// Chooses whether a path keeps its wavelengths here or leaves with excitations: once for all lanes, by what both are
  /// worth over all of them, so that each may stand for any other; then each lane draws an excitation of its own.
  /// @param u            the choice, and where in their rows the excitations lie
  /// @param throughput   of the path before
  /// @param lanes        take the excitations' wavelengths
  /// @return  what the throughput is multiplied with: reflectance or re-radiation over the choice's density
  template <int C>
  Lanes<C> stayOrShift(const Eigen::Vector2f& u, const Lanes<C>& throughput, const Lanes<C>& reflectance,
                       WavelengthSet<C>& lanes) const {
    float staying = 0;
    float shifting = 0;
    for (int k = 0; k < C; ++k) {
      const std::int32_t cell = lanes.cell[static_cast<std::size_t>(k)];
      staying += throughput[k] * reflectance[k] * light(cell);
      shifting += throughput[k] * shifted(cell);
    }
    if (!(shifting > 0.0F)) {
      return reflectance;
    }
    const float stays =
        staying > 0.0F ? std::clamp(staying / (staying + shifting), kLeastChance, 1.0F - kLeastChance) : 0.0F;
    if (u.x() < stays) {
      return reflectance / stays;
    }
    Lanes<C> factors;
    for (int k = 0; k < C; ++k) {
      std::int32_t& cell = lanes.cell[static_cast<std::size_t>(k)];
      factors[k] = 0.0F;
      if (!(shifted(cell) > 0.0F)) {
        continue;
      }
      const float place = u.y() + static_cast<float>(k) / static_cast<float>(C);
      const Excitation excitation = sample(cell, place - std::floor(place));
      cell = excitation.cell;
      lanes.nm[k] = kFirstEdgeNm + 0.5F + static_cast<float>(cell);
      factors[k] = excitation.weight / (1.0F - stays);
    }
    return factors;
  }

 private:
  static constexpr float kLeastChance = 0.1F;

  static std::size_t index(std::int32_t cell) {
    const std::int32_t at = cell + kUltravioletCells;
    return static_cast<std::size_t>(at);
  }
  /// Running sums of an emission's excitations, all below it: 0 first, the sum of all last.
  static std::size_t start(std::int32_t cell) { return index(cell) * (index(cell) + 1) / 2; }
  static std::size_t end(std::int32_t cell) { return start(cell) + index(cell); }

  std::vector<float> m_light;
  std::vector<float> m_below;
};

}  // namespace metamer::spectral_ref
