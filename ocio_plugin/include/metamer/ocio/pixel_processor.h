// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include <filesystem>
#include <span>

namespace metamer::ocio {

namespace OCIO = OCIO_NAMESPACE;

/// An OCIO transform on the CPU, float in and out. Safe to share between threads.
class PixelProcessor {
 public:
  /// @throws spectral::InputError where OCIO refuses the transform
  explicit PixelProcessor(const OCIO::ConstTransformRcPtr& transform);

  /// A LUT file of any format OCIO reads, 3-D tables looked up by tetrahedra.
  /// @throws spectral::InputError: no such file, or OCIO cannot read it
  static PixelProcessor fromFile(const std::filesystem::path& file);

  /// Applies to rgba.size() / 4 pixels in place; alpha is left alone. @throws spectral::InputError for half a pixel
  void apply(std::span<float> rgba) const;

  bool isNoOp() const { return m_isNoOp; }

 private:
  OCIO::ConstCPUProcessorRcPtr m_processor;
  bool m_isNoOp = false;
};

/// A LUT file as a transform that OCIO reads when a processor is made of it; 3-D tables are looked up by tetrahedra.
/// @throws spectral::InputError: no such file, or one that OCIO must not be given
OCIO::ConstTransformRcPtr fileTransform(const std::filesystem::path& file);

}  // namespace metamer::ocio
