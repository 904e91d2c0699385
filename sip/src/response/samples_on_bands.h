// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "metamer/sip/band_weights.h"

namespace metamer::sip {

/// Samples at the band centres, a column each.
inline Eigen::MatrixXd samplesOnBands(const std::vector<spectral::DomainSamples>& samples, int bandCount) {
  Eigen::MatrixXd bands(bandCount, static_cast<Eigen::Index>(samples.size()));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    bands.col(static_cast<Eigen::Index>(i)) = atBandCentres(samples[i], bandCount);
  }
  return bands;
}

}  // namespace metamer::sip
