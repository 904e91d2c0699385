// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/ray_group.h"
#include "metamer/spectral_ref/scene.h"
#include "wavelengths/lanes.h"

namespace metamer::spectral_ref {

/// A texture ready to be looked up: the reflectance at a hit, for the wavelengths of a path. Refers to the scene's.
class ReflectanceTexture {
 public:
  explicit ReflectanceTexture(const Texture& texture);

  template <int C>
  Lanes<C> at(const Hit& hit, const WavelengthSet<C>& wavelengths) const {
    const std::array<Pixel, 4> pixels = pixelsAt(hit);
    Lanes<C> result;
    for (int k = 0; k < C; ++k) {
      // In the ultraviolet it is as at 380 nm.
      const Place& place =
          m_places[static_cast<std::size_t>(std::max(wavelengths.cell[static_cast<std::size_t>(k)], 0))];
      float sum = 0;
      for (const Pixel& pixel : pixels) {
        const std::uint16_t* values = pixel.values + place.node;
        sum += pixel.weight *
               (static_cast<float>(values[0]) * (1.0F - place.share) + static_cast<float>(values[1]) * place.share);
      }
      result[k] = sum;
    }
    return result;
  }

 private:
  /// Of the four about a place.
  struct Pixel {
    const std::uint16_t* values;
    float weight;  ///< over the largest value; all four together one
  };
  /// Of a cell between two nodes.
  struct Place {
    std::uint32_t node;
    float share;  ///< of the next node
  };

  std::array<Pixel, 4> pixelsAt(const Hit& hit) const;
  /// On the picture: u to the right, v up, 0 ... 1 or, of a mesh, beyond.
  std::array<double, 2> placeOf(const Hit& hit) const;

  const Texture* m_texture;
  std::vector<Place> m_places;
};

}  // namespace metamer::spectral_ref
