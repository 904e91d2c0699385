// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include <optional>
#include <string>

#include "metamer/ocio/config_source.h"
#include "metamer/sip/recipe.h"
#include "metamer/spectral/data_library.h"

namespace metamer::ocio {

namespace OCIO = OCIO_NAMESPACE;

/// The space of the pixels that a transform is applied to, and the linear RGB that the engine works in.
struct WorkingSpace {
  std::string name;
  spectral::RgbSpace engine;  ///< of the engine; ACES2065-1 for a space of a config
  /// What stands before and after the engine's own operators, null where nothing does.
  OCIO::ConstTransformRcPtr toEngine;
  OCIO::ConstTransformRcPtr fromEngine;
  bool isLog = false;                             ///< pixels are a log signal, 0 ... 1
  bool isLinear = true;                           ///< pixels are scene-linear
  std::optional<spectral::LogEncoding> encoding;  ///< of a built-in log space: per-channel, over `engine`

  /// `group` with the conversions round it.
  OCIO::GroupTransformRcPtr wrapped(const OCIO::GroupTransformRcPtr& group) const;
};

/// A built-in space by its name, else a colour space (name, alias or role) of a config.
/// @param source  opened only where the space is not built in; none: built-in spaces only
/// @throws spectral::InputError: unknown (near names listed); a config that cannot be read, or is without the role
///         aces_interchange; a space that holds data
WorkingSpace findWorkingSpace(const std::string& name, const spectral::DataLibrary& library,
                              const ConfigSource& source);
/// A recipe's. @throws spectral::InputError as findWorkingSpace, with the recipe's file
WorkingSpace workingSpaceOf(const sip::Recipe& recipe, const spectral::DataLibrary& library,
                            const ConfigSource& source);

}  // namespace metamer::ocio
