// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "metamer/ocio/representation.h"

namespace metamer::lutgen {

/// "exposure-invariant chain of 65 nodes", "matrix".
inline std::string representationText(ocio::Representation representation, int size) {
  return ocio::nameOf(representation) + (size > 0 ? " of " + std::to_string(size) + " nodes" : "");
}

}  // namespace metamer::lutgen
