// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "metamer/spectral/spectrum.h"

namespace metamer::spectral {

/// A channel of a picture at a pixel, or its mean over all pixels.
struct ChannelValue {
  std::string name;
  double value = 0;
};

/// A pixel, in the coordinates of the picture's data window.
struct PicturePlace {
  int x = 0;
  int y = 0;
};

/// Reads the channels of a picture whose names `isWanted`, of its first part that has any; without a place their means.
using PictureChannelReader =
    std::function<std::vector<ChannelValue>(const std::string& file, const std::optional<PicturePlace>& place,
                                            const std::function<bool(const std::string& channel)>& isWanted)>;

/// Reads the channels of FILE whose names `isWanted`. This library reads no pictures: a program that does gives its
/// reader, to the data library (DataLibrary::openDefault) or to a call.
/// @param place     "x,y" of a pixel, or "" for the mean of all
/// @param pictures  may be empty
/// @throws InputError: no reader, a place that is none, what the reader refuses
std::vector<ChannelValue> readPictureChannels(const std::string& file, const std::string& place,
                                              const std::function<bool(const std::string& channel)>& isWanted,
                                              const PictureChannelReader& pictures);

/// Wavelength of a channel in the layout of Fichet et al., JCGT 2021: "S0.550,000000nm" of a light's radiance,
/// "T.550,000000nm" of a reflectance or transmittance; layers ("left.S0.550nm"), units of m, um or Hz with their
/// prefixes. Empty: another channel. S1 to S3, polarisation, are others.
std::optional<double> channelWavelengthNm(const std::string& channel, SpectralQuantity quantity);

/// The channel of a wavelength in that layout, its section 3: a decimal comma, six digits. Of power distributions "S0",
/// else "T".
std::string channelOfWavelength(double nm, SpectralQuantity quantity);

/// The spectrum of a picture's pixel ("x,y"), or the mean of all ("").
/// @throws InputError: no reader, a place that is none, no channels of the quantity, what readers refuse
std::vector<Spectrum> readSpectralPicture(const std::string& file, const std::string& place, SpectralQuantity quantity,
                                          const PictureChannelReader& pictures);

}  // namespace metamer::spectral
