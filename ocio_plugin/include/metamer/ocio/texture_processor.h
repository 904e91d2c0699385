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

/// What OCIO's shader for a transform is made of: what can be one operator is one.
/// @throws spectral::InputError where OCIO refuses it
OCIO::ConstGroupTransformRcPtr shaderOperators(const OCIO::ConstTransformRcPtr& transform);

/// The same of a LUT file of any format that it reads.
/// @throws spectral::InputError: no such file, or OCIO cannot read it
OCIO::ConstGroupTransformRcPtr shaderOperators(const std::filesystem::path& file);

/// These operators as a graphics card runs them: their tables as textures of that depth, 3-D tables looked up by
/// tetrahedra where they say so. Emulated on the processor; a test holds it to the shader itself.
/// @throws spectral::InputError where OCIO refuses an operator
PixelProcessor textureProcessor(const OCIO::ConstGroupTransformRcPtr& operators, TextureDepth depth);

}  // namespace metamer::ocio
