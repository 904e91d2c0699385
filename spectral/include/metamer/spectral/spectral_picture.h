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

/// This library reads no pictures. A program that does gives the reader when it starts, before other threads: then .exr
/// is a spectral file (readSpectralFile). Without one such files are refused.
void setPictureChannelReader(PictureChannelReader reader);

/// Reads by that reader the channels of FILE whose names `isWanted`.
/// @param place  "x,y" of a pixel, or "" for the mean of all
/// @throws InputError: no reader, a place that is none, what the reader refuses
std::vector<ChannelValue> readPictureChannels(const std::string& file, const std::string& place,
                                              const std::function<bool(const std::string& channel)>& isWanted);

/// Wavelength of a channel in the layout of Fichet et al., JCGT 2021: "S0.550,000000nm" of a light's radiance,
/// "T.550,000000nm" of a reflectance or transmittance; layers ("left.S0.550nm"), units of m, um or Hz with their
/// prefixes. Empty: another channel. S1 to S3, polarisation, are others.
std::optional<double> channelWavelengthNm(const std::string& channel, SpectralQuantity quantity);

/// The channel of a wavelength in that layout, its section 3: a decimal comma, six digits. Of power distributions "S0",
/// else "T".
std::string channelOfWavelength(double nm, SpectralQuantity quantity);

/// The spectrum of a picture's pixel ("x,y"), or the mean of all ("").
/// @throws InputError: no reader, a place that is none, no channels of the quantity, what readers refuse
std::vector<Spectrum> readSpectralPicture(const std::string& file, const std::string& place, SpectralQuantity quantity);

}  // namespace metamer::spectral
