// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "metamer/spectral/spectral_picture.h"

namespace metamer::spectral {

/// A PictureChannelReader of OpenEXR: scanlines and tiles, any part, compression and type of channel; one row of pixels
/// in memory at a time.
/// @throws InputError: no file, what is damaged or no OpenEXR picture
std::vector<ChannelValue> readExrChannels(const std::string& file, const std::optional<PicturePlace>& place,
                                          const std::function<bool(const std::string& channel)>& isWanted);

}  // namespace metamer::spectral
