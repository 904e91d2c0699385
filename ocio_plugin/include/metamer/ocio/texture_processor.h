// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "metamer/ocio/pixel_processor.h"

namespace metamer::ocio {

/// What a viewer on a graphics card keeps of a table's numbers.
enum class TextureDepth {
  Float,  ///< 32 bits, as OCIO hands them out
  Half    ///< 16 bits, to the nearest: 11 digits of two, infinite beyond 65504
};

/// A transform as OCIO's shader runs it on a graphics card: the same operators, their tables as textures of that depth,
/// 3-D tables looked up by tetrahedra where the transform says so. Emulated on the processor; a test holds it to the
/// shader itself.
/// @throws spectral::InputError where OCIO refuses the transform
PixelProcessor textureProcessor(const OCIO::ConstTransformRcPtr& transform, TextureDepth depth);

/// The same of a LUT file of any format OCIO reads. @throws spectral::InputError: no such file, or OCIO cannot read it
PixelProcessor textureProcessor(const std::filesystem::path& file, TextureDepth depth);

}  // namespace metamer::ocio
