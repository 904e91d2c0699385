// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "exr/exr_file.h"
#include "exr/exr_samples.h"
#include "exr/zip_block.h"

namespace metamer::lutgen {

// Chunks, packed and unpacked: ZIP itself, the other compressions by OpenEXR's library, which is handed each chunk as a
// small file. Safe on several threads.

/// @param rectangle  of the chunk's samples; of tiles it begins at 0, 0
/// @param file  for messages
/// @throws spectral::InputError where the bytes are damaged
std::string unpackedChunk(const ExrPart& part, const ExrRectangle& rectangle, std::string_view packed,
                          const std::string& file);

/// @param samples  row by row, of each row channel by channel
/// @param zipLevel  for ZIP and ZIPS
/// @throws spectral::InputError where the library fails
std::string packedChunk(const ExrPart& part, const ExrRectangle& rectangle, const std::string& samples,
                        const std::string& file, int zipLevel = kUsualZipLevel);

}  // namespace metamer::lutgen
