// SPDX-License-Identifier: Apache-2.0
#include "map/map_source.h"

#include <Eigen/LU>
#include <cmath>

namespace metamer::sip {

namespace {

/// Cube coordinates from the white-normalised response (a, b, c): (2a - s, 2b - s, s), s the sum. On the front face
/// they are chromaticity stretched to -1 ... 1; all that reflectances can make lies there.
Eigen::Matrix3d cubeFromResponse() {
  Eigen::Matrix3d matrix;
  matrix << 1, -1, -1,  //
      -1, 1, -1,        //
      1, 1, 1;
  return matrix;
}

/// Scaled by a power of two so that no float32 colour's coordinates overflow.
Eigen::Matrix3d withoutOverflow(const Eigen::Matrix3d& cubeFromRgb) {
  int exponent = 0;
  std::frexp(cubeFromRgb.cwiseAbs().rowwise().sum().maxCoeff(), &exponent);
  return std::ldexp(1.0, -exponent) * cubeFromRgb;
}

}  // namespace

MapSource::MapSource(const SpectralTransform& given, double givenTolerance, int givenFewerLevels)
    : transform(given),
      tolerance(givenTolerance),
      fewerLevels(givenFewerLevels),
      cubeFromRgb(withoutOverflow(cubeFromResponse() * given.responseFromRgb())),
      rgbFromCube(cubeFromRgb.inverse()),
      metric(given.space()),
      known(knownPoints(given, cubeFromRgb, metric)) {}

}  // namespace metamer::sip
