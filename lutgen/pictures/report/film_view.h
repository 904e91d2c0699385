// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "apply/picture_space.h"
#include "metamer/spectral/rgb_space.h"

namespace metamer::lutgen {

/// Scene light as a film-like view shows it on an sRGB screen: the output transform of ACES for 100 nits and Rec.709,
/// the newest of page/film_view.json that the linked OpenColorIO has. Highlights roll off and lose their colour, where
/// a screen alone would clip.
class FilmView {
 public:
  /// @param space  of the light
  /// @param aces  ACES2065-1
  /// @throws spectral::InputError where OpenColorIO has no such transform
  FilmView(const spectral::RgbSpace& space, const spectral::RgbSpace& aces);

  /// Linear RGBA to the screen's signal, 0 ... 1, in place; alpha is left alone.
  void show(std::span<float> rgba) const { m_show(rgba); }
  /// The light that the view shows as these signals. A picture's white, 1, is taken for film_view.json's
  /// `brightest`: undone, some 20 times a white surface, where 1 would be 128.
  void undo(std::span<float> rgba) const;
  /// "ACES 2.0"
  const std::string& name() const { return m_name; }

 private:
  float m_brightest = 0.0F;
  PixelFunction m_show;
  PixelFunction m_undo;
  std::string m_name;
};

}  // namespace metamer::lutgen
