// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "metamer/spectral/vector_lanes.h"
#include "metamer/spectral_ref/scene.h"

namespace metamer::spectral_ref {

/// One value for each of the C wavelengths of a path.
template <int C>
using Lanes = Eigen::Array<float, C, 1>;

/// Integrals over wavelength are sums over the cells 380 +- 0.5, 381 +- 0.5, ... nm: a continuous wavelength looks up
/// the cell it lies in, so the expectation of a render is the sum over the 1 nm domain that the rest of metamer uses.
inline constexpr int kCells = spectral::kDomainSize;
/// Cells of light that excites fluorescence and is not seen: -80 is 300 nm, -1 379 nm.
inline constexpr int kUltravioletCells = spectral::kDomainInExcitation;
inline constexpr float kFirstEdgeNm = static_cast<float>(spectral::kDomainStartNm) - 0.5F;

/// Whether any of some lanes, none below zero, is above it, or no number.
template <typename Values>
bool isAnyAbove(const Values& lanes) {
  return !(lanes.sum() <= 0.0F);
}

/// The wavelengths a path carries; lane 0 is the hero.
template <int C>
struct WavelengthSet {
  std::array<std::int32_t, C> cell;  ///< 0 ... 400; from -80 on once a fluorescent surface has shifted it
  Lanes<C> nm;
  Lanes<C> weight;  ///< 1 / (C density(nm)): what a lane's radiance counts, density in 1/nm
};

/// All spectra of a scene at 1 nm, one after another.
class SpectrumTables {
 public:
  explicit SpectrumTables(const Scene& scene) {
    m_values.reserve(scene.spectra.size() * kStride);
    for (SpectrumId id = 0; id < scene.spectra.size(); ++id) {
      for (const double value : scene.whole(id)) {
        m_values.push_back(static_cast<float>(value));
      }
    }
  }

  /// Of cell 0; those before are the ultraviolet.
  const float* table(SpectrumId id) const { return m_values.data() + std::size_t{id} * kStride + kUltravioletCells; }

  template <int C>
  METAMER_ALWAYS_INLINE Lanes<C> at(SpectrumId id, const WavelengthSet<C>& wavelengths) const {
    const float* values = table(id);
    Lanes<C> result;
    for (int k = 0; k < C; ++k) {
      result[k] = values[wavelengths.cell[static_cast<std::size_t>(k)]];
    }
    return result;
  }

 private:
  static constexpr std::size_t kStride = kUltravioletCells + kCells;

  std::vector<float> m_values;
};

}  // namespace metamer::spectral_ref
