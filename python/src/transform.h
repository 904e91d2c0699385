// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "metamer/sip/homogeneous_map.h"
#include "metamer/sip/spectral_transform.h"
#include "metamer/spectral/log_encoding.h"
#include "pixels.h"

namespace metamer::python {

/// The exact engine on pixels of a recipe's space, which may be a log space.
struct Transform {
  std::shared_ptr<const sip::SpectralTransform> engine;
  std::optional<spectral::LogEncoding> encoding;

  /// On linear pixels, whatever the recipe's space.
  PixelFunction linearFunction() const;
  PixelFunction function() const;
};

/// The same through a map.
struct Map {
  sip::HomogeneousMap tables;
  std::optional<spectral::LogEncoding> encoding;

  PixelFunction linearFunction() const;
  PixelFunction function() const;
};

void bindMap(nb::module_& module);

}  // namespace metamer::python
