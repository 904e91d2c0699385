// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/pixel_processor.h"

#include <string>

#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/library_words.h"
#include "metamer/spectral/missing_file_error.h"
#include "metamer/spectral/path_text.h"
#include "operators/lut_file.h"

namespace metamer::ocio {

PixelProcessor::PixelProcessor(const OCIO::ConstTransformRcPtr& transform) {
  try {
    const auto processor = OCIO::Config::CreateRaw()->getProcessor(transform);
    m_isNoOp = processor->isNoOp();
    // The default optimisations but for the fast, less exact logarithm: results are to be those of any release.
    const auto flags =
        static_cast<OCIO::OptimizationFlags>(OCIO::OPTIMIZATION_DEFAULT & ~OCIO::OPTIMIZATION_FAST_LOG_EXP_POW);
    m_processor = processor->getOptimizedCPUProcessor(OCIO::BIT_DEPTH_F32, OCIO::BIT_DEPTH_F32, flags);
  } catch (const OCIO::Exception& error) {
    throw spectral::InputError("OpenColorIO", "", "", spectral::colourReason(error.what()));
  }
}

OCIO::ConstTransformRcPtr fileTransform(const std::filesystem::path& file) {
  refuseOddLut(file);
  std::error_code none;
  if (!std::filesystem::is_regular_file(file, none)) {
    throw spectral::MissingFileError(spectral::utf8(file), "LUT", "", "there is no such file; check the path");
  }
  auto transform = OCIO::FileTransform::Create();
  // OCIO looks relative paths up in its search path, and keeps what it has read by name.
  transform->setSrc(spectral::utf8(std::filesystem::absolute(file)).c_str());
  transform->setInterpolation(OCIO::INTERP_BEST);
  return transform;
}

PixelProcessor PixelProcessor::fromFile(const std::filesystem::path& file) {
  const OCIO::ConstTransformRcPtr transform = fileTransform(file);
  try {
    return PixelProcessor(transform);
  } catch (const spectral::InputError& error) {
    const std::string remedy = remedyOfLut(file);
    throw spectral::InputError(
        spectral::utf8(file), "LUT", "",
        "cannot be read: " + (remedy.empty() ? error.what() + std::string("; export it again") : remedy));
  }
}

void PixelProcessor::apply(std::span<float> rgba) const {
  spectral::requirePixels(static_cast<std::int64_t>(rgba.size()));
  if (rgba.empty()) {
    return;
  }
  OCIO::PackedImageDesc pixels(rgba.data(), static_cast<long>(rgba.size() / 4), 1, 4);
  m_processor->apply(pixels);
}

}  // namespace metamer::ocio
