// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include <initializer_list>

namespace metamer::ocio {

namespace OCIO = OCIO_NAMESPACE;

/// Transforms one after the other, as a group of copies; null ones are left out.
inline OCIO::GroupTransformRcPtr chained(std::initializer_list<OCIO::ConstTransformRcPtr> transforms) {
  auto group = OCIO::GroupTransform::Create();
  for (const auto& transform : transforms) {
    if (transform) {
      group->appendTransform(transform->createEditableCopy());
    }
  }
  return group;
}

}  // namespace metamer::ocio
