// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace metamer::spectral {

/// Makes spectral OpenEXR pictures spectral files of this program (setPictureChannelReader). Scanlines and tiles, any
/// part, compression and type of channel; one row of pixels in memory at a time.
void readSpectraFromExr();

}  // namespace metamer::spectral
