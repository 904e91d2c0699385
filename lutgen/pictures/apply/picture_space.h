// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>

#include "exr/exr_change.h"
#include "metamer/ocio/config_source.h"
#include "metamer/spectral/data_library.h"
#include "metamer/spectral/rgb_space.h"

namespace metamer::lutgen {

/// What a picture's pixels are: linear RGB, behind a curve where they are encoded.
struct PictureSpace {
  std::string name;
  spectral::RgbSpace linear;
  PixelFunction decode;  ///< to `linear`; empty: pixels are linear
  PixelFunction encode;
  bool isDisplay = false;  ///< a screen's signal: what it shows is what the picture is to look like
  bool isLinear() const { return !decode; }
};

/// What a file says of its pixels.
struct SpaceClues {
  std::string format;                                  ///< OpenImageIO's: "openexr", "png", ...
  std::string named;                                   ///< oiio:ColorSpace, colorInteropID; empty: none
  std::string profile;                                 ///< description of an ICC profile; empty: none
  std::string profileColours;                          ///< as coloursOfProfile(); empty: none
  std::optional<std::array<float, 8>> chromaticities;  ///< xy of red, green, blue, white
  bool isFloat = true;
  bool isInks = false;  ///< CMYK, of which red, green and blue were made without a profile
};

/// A space by its name: metamer's own (lutgen list spaces), sRGB, "Rec.1886", "Gamma 2.2", ..., a colour space of the
/// config in $OCIO, or of OpenColorIO's own studio config ("sRGB - Texture").
/// @param field  what messages call it
/// @throws spectral::InputError: unknown, near names
PictureSpace pictureSpaceNamed(const std::string& name, const std::string& field, const spectral::DataLibrary& library,
                               const ocio::ConfigSource& config);

/// What the file says its pixels are. Empty where it does not.
/// @param notes  gets a line where it is doubtful
/// @throws spectral::InputError where it says what is not known here (a log of film densities): what to give
std::optional<PictureSpace> pictureSpaceOf(const SpaceClues& clues, const std::string& file,
                                           const spectral::DataLibrary& library, std::string& note);

/// RGB linear in `from` as RGB linear in `to`, white to white (Bradford). Empty where they are one space.
PixelFunction between(const spectral::RgbSpace& from, const spectral::RgbSpace& to);

/// One after the other; empty ones left out, empty where all are.
PixelFunction inTurn(std::vector<PixelFunction> functions);

}  // namespace metamer::lutgen
