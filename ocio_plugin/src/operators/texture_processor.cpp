// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/texture_processor.h"

#include <Eigen/Core>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/library_words.h"

namespace metamer::ocio {
namespace {

float asHalf(float value) {
  return static_cast<float>(Eigen::half(value));
}

/// A table of three numbers an entry with each as a half.
template <typename Table, typename... Indices>
void roundEntry(Table& table, Indices... indices) {
  float red = 0.0F;
  float green = 0.0F;
  float blue = 0.0F;
  table.getValue(indices..., red, green, blue);
  table.setValue(indices..., asHalf(red), asHalf(green), asHalf(blue));
}

void roundTable(OCIO::Lut1DTransform& table) {
  for (unsigned long i = 0; i < table.getLength(); ++i) {
    roundEntry(table, i);
  }
}

void roundTable(OCIO::Lut3DTransform& table) {
  const unsigned long size = table.getGridSize();
  for (unsigned long r = 0; r < size; ++r) {
    for (unsigned long g = 0; g < size; ++g) {
      for (unsigned long b = 0; b < size; ++b) {
        roundEntry(table, r, g, b);
      }
    }
  }
}

template <typename Table>
bool roundIf(const OCIO::TransformRcPtr& transform) {
  const auto table = OCIO_DYNAMIC_POINTER_CAST<Table>(transform);
  if (table) {
    roundTable(*table);
  }
  return table != nullptr;
}

}  // namespace

OCIO::ConstGroupTransformRcPtr shaderOperators(const OCIO::ConstTransformRcPtr& transform) {
  try {
    // As for a shader: tables that are asked backwards are made anew.
    return OCIO::Config::CreateRaw()
        ->getProcessor(transform)
        ->getOptimizedProcessor(OCIO::BIT_DEPTH_F32, OCIO::BIT_DEPTH_F32, OCIO::OPTIMIZATION_DEFAULT)
        ->createGroupTransform();
  } catch (const OCIO::Exception& error) {
    throw spectral::InputError("OpenColorIO", "", "", spectral::colourReason(error.what()));
  }
}

OCIO::ConstGroupTransformRcPtr shaderOperators(const std::filesystem::path& file) {
  return shaderOperators(fileTransform(file));
}

PixelProcessor textureProcessor(const OCIO::ConstGroupTransformRcPtr& operators, TextureDepth depth) {
  if (depth == TextureDepth::Float) {
    return PixelProcessor(operators);
  }
  const auto rounded = OCIO::GroupTransform::Create();
  for (int k = 0; k < operators->getNumTransforms(); ++k) {
    // A copy of each: one of the group would share its tables.
    const OCIO::TransformRcPtr each = operators->getTransform(k)->createEditableCopy();
    roundIf<OCIO::Lut1DTransform>(each) || roundIf<OCIO::Lut3DTransform>(each);
    rounded->appendTransform(each);
  }
  return PixelProcessor(rounded);
}

}  // namespace metamer::ocio
