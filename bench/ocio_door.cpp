// SPDX-License-Identifier: Apache-2.0
// A C door to one release of OpenColorIO: LUT files on pixels. Built for the release that is linked and for an older
// one.
#include <OpenColorIO/OpenColorIO.h>

#include <memory>

namespace OCIO = OCIO_NAMESPACE;

namespace {

/// ACEScct (Academy S-2016-001) as the peers' script writes it.
OCIO::LogCameraTransformRcPtr acescct(OCIO::TransformDirection direction) {
  const double linearBreak[3] = {0.0078125, 0.0078125, 0.0078125};
  const double logSlope[3] = {1 / 17.52, 1 / 17.52, 1 / 17.52};
  const double logOffset[3] = {9.72 / 17.52, 9.72 / 17.52, 9.72 / 17.52};
  const double linearSlope[3] = {10.5402377416545, 10.5402377416545, 10.5402377416545};
  auto transform = OCIO::LogCameraTransform::Create(linearBreak);
  transform->setBase(2.0);
  transform->setLogSideSlopeValue(logSlope);
  transform->setLogSideOffsetValue(logOffset);
  transform->setLinearSlopeValue(linearSlope);
  transform->setDirection(direction);
  return transform;
}

}  // namespace

extern "C" const char* metamerOcioVersion() {
  return OCIO::GetVersion();
}

/// A processor of a file; `logInOut`: between ACEScct and its inverse; `exactLog`: with the exact logarithm, as metamer
/// runs a file, not the fast one that programs have by default. Lives as long as the program. Null where OCIO refuses
/// the file.
extern "C" void* metamerFile(const char* path, int logInOut, int exactLog) try {
  auto file = OCIO::FileTransform::Create();
  file->setSrc(path);
  file->setInterpolation(OCIO::INTERP_BEST);
  auto group = OCIO::GroupTransform::Create();
  if (logInOut != 0) {
    group->appendTransform(acescct(OCIO::TRANSFORM_DIR_FORWARD));
  }
  group->appendTransform(file);
  if (logInOut != 0) {
    group->appendTransform(acescct(OCIO::TRANSFORM_DIR_INVERSE));
  }
  const auto exact =
      static_cast<OCIO::OptimizationFlags>(OCIO::OPTIMIZATION_DEFAULT & ~OCIO::OPTIMIZATION_FAST_LOG_EXP_POW);
  const auto flags = exactLog != 0 ? exact : OCIO::OPTIMIZATION_DEFAULT;
  const auto processor = OCIO::Config::CreateRaw()->getProcessor(group);
  return std::make_unique<OCIO::ConstCPUProcessorRcPtr>(
             processor->getOptimizedCPUProcessor(OCIO::BIT_DEPTH_F32, OCIO::BIT_DEPTH_F32, flags))
      .release();
} catch (const OCIO::Exception&) {
  return nullptr;
}

extern "C" void metamerFileApply(void* processor, const float* source, float* destination, std::size_t pixels) {
  // OCIO reads the source only.
  OCIO::PackedImageDesc from(const_cast<float*>(source), static_cast<long>(pixels), 1, 4);
  OCIO::PackedImageDesc to(destination, static_cast<long>(pixels), 1, 4);
  (*static_cast<OCIO::ConstCPUProcessorRcPtr*>(processor))->apply(from, to);
}
