// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/observer.h"

namespace metamer::spectral {

Eigen::Matrix<double, kDomainSize, 3> Observer::onDomain() const {
  Eigen::Matrix<double, kDomainSize, 3> samples;
  for (Eigen::Index k = 0; k < 3; ++k) {
    samples.col(k) = curves[static_cast<std::size_t>(k)].onDomain();
  }
  return samples;
}

}  // namespace metamer::spectral
