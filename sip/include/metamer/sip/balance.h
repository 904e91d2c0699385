// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "metamer/spectral/chromatic_adaptation.h"

namespace metamer::sip {

/// How the light's colour was taken out of a picture, on its way from the sensor to the working space. It decides which
/// response a pixel stands for: pictures of one scene that were balanced in different ways differ in all but greys.
struct Balance {
  enum class Kind {
    Cat,     ///< by a chromatic adaptation on XYZ
    Camera,  ///< by gains on the channels of the camera that is the observer, then its matrix for daylight (D65); an
             ///< observer that is no camera: as Bradford, which comes nearest to what cameras do
    Rgb,     ///< by gains on red, green and blue of the working space: a grey card
    None,    ///< not at all: a grey has the colour of the light, and (1,1,1) is not the perfect reflector
  };
  Kind kind = Kind::Cat;
  spectral::ChromaticAdaptation cat = spectral::ChromaticAdaptation::Bradford;  ///< Cat alone

  bool operator==(const Balance&) const = default;
};

/// What a message says of any other name.
inline constexpr const char* kBalanceRemedy = "must be camera, rgb, none, vonkries, bradford, cat02 or cat16";
/// "camera", "rgb", "none", or a chromatic adaptation's name. @throws spectral::InputError for any other (lists these)
Balance balanceFromName(const std::string& name);
std::string nameOf(const Balance& balance);

}  // namespace metamer::sip
