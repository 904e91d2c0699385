// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "apply/any_picture.h"
#include "apply/picture_space.h"
#include "metamer/skin/skin_pixel.h"
#include "skin/skin_capture.h"

namespace metamer::lutgen {

/// Channels of a picture of maps, in the order of a pixel's numbers: parameters, gain, residual.
inline constexpr std::array<const char*, 9> kSkinChannels = {
    "skin.melanin", "skin.blood",      "skin.thickness",  "skin.melanin_type", "skin.deoxygenation",
    "skin.gain",    "skin.residual.R", "skin.residual.G", "skin.residual.B"};

/// What a picture of maps says of the albedo that it was made from, in its header.
struct SkinMapsHeader {
  SkinCapture capture;
  std::vector<std::string> channels;  ///< names of red, green, blue
};

/// Where the maps lie in a picture.
struct SkinMapsPlace {
  int part = 0;
  std::vector<int> channels;  ///< as kSkinChannels
};

/// Whether any channel of a picture is a map's.
bool hasSkinMaps(const AnyPicture& picture);
/// @throws spectral::InputError where channels are missing (names them), or lie in several parts
SkinMapsPlace findSkinMaps(const AnyPicture& picture, const std::string& file);

SkinMapsHeader skinMapsHeader(const AnyPicture& picture, int part);
void setSkinMapsHeader(AnyPicture& picture, int part, const SkinMapsHeader& header);

std::vector<skin::SkinPixel> skinPixels(const AnyPicture& picture, const SkinMapsPlace& place);
/// Nine numbers a pixel, as kSkinChannels.
std::vector<float> skinNumbers(const std::vector<skin::SkinPixel>& pixels);

/// Colours, three numbers a pixel, through a function of RGBA pixels, in place. Pixels that are not finite stay.
void changeColours(std::vector<float>& rgb, const PixelFunction& function);

}  // namespace metamer::lutgen
