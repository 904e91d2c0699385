// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

namespace metamer::ocio {

namespace OCIO = OCIO_NAMESPACE;

/// A signal between 0 and 1 that stands for the engine's linear RGB.
struct Signal {
  OCIO::ConstTransformRcPtr toEngine;
  OCIO::ConstTransformRcPtr fromEngine;
};

}  // namespace metamer::ocio
