// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "wavelengths/lanes.h"

namespace metamer::spectral_ref {

/// What a clear sheet of an index passes at normal incidence, reflections within it included: (1 - R) / (1 + R).
double clearSheet(double index);

/// A gel as a plane sheet of coloured matter: it absorbs along the way through it (Bouguer), and both its faces reflect
/// (Fresnel, unpolarised), to and fro within it without interference. At normal incidence it passes what its spectrum
/// says; what its faces reflect is lost to the scene.
class GelSheet {
 public:
  /// @param transmittance  measured at normal incidence, both faces included, at most clearSheet(index)
  /// @param index  of the sheet, the same at all wavelengths, at least 1
  GelSheet(const spectral::ExcitationSamples& transmittance, double index);

  /// @param cosine  of the ray to the normal outside, 0 ... 1
  template <int C>
  Lanes<C> transmittance(float cosine, const WavelengthSet<C>& wavelengths) const {
    const Faces faces = facesAt(cosine);
    Lanes<C> result;
    for (int k = 0; k < C; ++k) {
      const std::int32_t place = wavelengths.cell[static_cast<std::size_t>(k)] + kUltravioletCells;
      const auto cell = static_cast<std::size_t>(place);
      // What passes the matter once, along the slanting way.
      const float within = std::exp(m_logWithin[cell] * faces.way);
      result[k] = 0.5F * (passed(faces.across, within) + passed(faces.parallel, within));
    }
    return result;
  }

 private:
  struct Faces {
    float across;  ///< reflectance of a face for either polarisation
    float parallel;
    float way;  ///< through the sheet, over its thickness
  };
  Faces facesAt(float cosine) const;
  static float passed(float reflectance, float within) {
    const float in = 1.0F - reflectance;
    const float again = reflectance * within;
    return in * in * within / (1.0F - again * again);
  }

  float m_index;
  std::vector<float> m_logWithin;  ///< by cell from 300 nm on: natural logarithm of what the matter passes, straight
};

}  // namespace metamer::spectral_ref
