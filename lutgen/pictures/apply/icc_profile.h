// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>

#include <string>

namespace metamer::lutgen {

/// The colours that a picture's ICC profile is of, as profiles write them: "RGB ", "CMYK", "Lab ", "GRAY", ...
/// @param spec  what OpenImageIO says of it
/// @param file  read where it is a PNG: its library drops profiles that are not of RGB without a word
/// @return empty without a profile
std::string coloursOfProfile(const OIIO::ImageSpec& spec, const std::string& file);

}  // namespace metamer::lutgen
