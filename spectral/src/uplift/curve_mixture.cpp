// SPDX-License-Identifier: Apache-2.0
#include "uplift/curve_mixture.h"

#include "metamer/spectral/vector_lanes.h"

namespace metamer::spectral {
namespace {

METAMER_VECTOR_LANES void mix(const std::array<const double*, 3>& curves, const Eigen::Vector3d& weights,
                              Eigen::Index count, double* spectrum) {
  const auto [first, second, third] = curves;
  const double ofFirst = weights[0];
  const double ofSecond = weights[1];
  const double ofThird = weights[2];
  for (Eigen::Index i = 0; i < count; ++i) {
    spectrum[i] = ofFirst * first[i] + ofSecond * second[i] + ofThird * third[i];
  }
}

}  // namespace

void mixCurves(const std::array<const Eigen::VectorXd*, 3>& curves, const Eigen::Vector3d& weights, double* spectrum) {
  mix({curves[0]->data(), curves[1]->data(), curves[2]->data()}, weights, curves[0]->size(), spectrum);
}

}  // namespace metamer::spectral
