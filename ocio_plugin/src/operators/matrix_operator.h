// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include <Eigen/Core>

namespace metamer::ocio {

/// A 3 x 3 matrix on RGB as an OCIO operator; alpha is left alone.
inline OCIO_NAMESPACE::MatrixTransformRcPtr matrixOperator(const Eigen::Matrix3d& matrix) {
  double values[16] = {};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      values[4 * row + column] = matrix(row, column);
    }
  }
  values[15] = 1.0;
  auto transform = OCIO_NAMESPACE::MatrixTransform::Create();
  transform->setMatrix(values);
  return transform;
}

}  // namespace metamer::ocio
