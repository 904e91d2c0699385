// SPDX-License-Identifier: Apache-2.0
// A C door to the OpenColorIO that metamer is linked with: LUT files on pixels.
#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <memory>

#include "metamer/ocio/pixel_processor.h"

using namespace metamer;
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

extern "C" const char* metamerLinkedOcioVersion() {
  return OCIO::GetVersion();
}

/// A processor of a file; `logInOut`: between ACEScct and its inverse. Lives as long as the program.
extern "C" void* metamerFile(const char* path, int logInOut) {
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
  return std::make_unique<ocio::PixelProcessor>(group).release();
}

extern "C" void metamerFileApply(void* processor, const float* source, float* destination, std::size_t pixels) {
  std::copy_n(source, 4 * pixels, destination);
  static_cast<ocio::PixelProcessor*>(processor)->apply({destination, 4 * pixels});
}
