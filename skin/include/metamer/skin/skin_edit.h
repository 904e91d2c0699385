// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "metamer/skin/skin_pixel.h"

namespace metamer::skin {

// Edits of estimated skin (section 3.9). Each changes parameters alone, within their ranges: gains and residuals stay,
// so that what is not edited keeps its colour. A matte, where one is given, has a number a pixel: 0 leaves it, 1 edits
// it in full, between is between (what is below 0, above 1 or no number is 0, 1 and 0).

/// What can be edited by name.
enum class SkinQuantity { Melanin, Blood, Thickness, Eumelanin, Deoxyhaemoglobin };

/// "melanin", "blood", "thickness", "eumelanin", "deoxyhaemoglobin". @throws spectral::InputError for any other
SkinQuantity skinQuantityFromName(const std::string& name);

/// One number a pixel, or empty.
using Matte = std::span<const float>;

/// Multiplies a quantity. @param factor  0 ... 1000
/// @throws spectral::InputError outside that range, or for a matte of another length: so do all below
void multiplySkin(std::span<SkinPixel> pixels, SkinQuantity quantity, double factor, Matte matte = {});
/// Sets a quantity. @param value  in its range
void setSkin(std::span<SkinPixel> pixels, SkinQuantity quantity, double value, Matte matte = {});
/// Smooths a quantity over a picture with a Gaussian, which pixels outside do not take part in.
/// @param width        of the picture; pixels are whole rows
/// @param radiusPixels standard deviation, above 0, up to 1000
void smoothSkin(std::span<SkinPixel> pixels, SkinQuantity quantity, int width, double radiusPixels, Matte matte = {});

/// More melanin, more of it eumelanin, a thicker epidermis: (1 + strength) times the melanin, strength / 4 of the way
/// to eumelanin alone, (1 + strength / 10) times the thickness. @param strength  0 ... 4
void tanSkin(std::span<SkinPixel> pixels, double strength, Matte matte = {});
/// More blood with more oxygen in it: (1 + strength) times the blood, 1 / (1 + strength) of the haemoglobin without
/// oxygen. Below 0, pallor. @param strength  -0.9 ... 4
void flushSkin(std::span<SkinPixel> pixels, double strength, Matte matte = {});
/// Moves haemoglobin without oxygen towards none (1) or towards all (-1). @param strength  -1 ... 1
void oxygenateSkin(std::span<SkinPixel> pixels, double strength, Matte matte = {});
/// Multiplies the thickness: below 1 thins, as with age, above it thickens. @param factor  0.01 ... 100
void thickenSkin(std::span<SkinPixel> pixels, double factor, Matte matte = {});
/// Takes melanin away. @param strength  0 ... 1, all of it
void bleachSkin(std::span<SkinPixel> pixels, double strength, Matte matte = {});

}  // namespace metamer::skin
