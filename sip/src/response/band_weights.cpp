// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/band_weights.h"

#include <algorithm>

#include "metamer/spectral/argument_checks.h"

namespace metamer::sip {

using spectral::kDomainSize;

namespace {

/// Where domain sample `index` lies between band centres: it belongs to hat `band` by `1 - fraction`, to the next by
/// `fraction`.
struct BandPosition {
  int band;
  double fraction;
};

BandPosition bandPosition(int index, int bandCount) {
  // Exact where centres fall on samples: integer arithmetic before the one division.
  const int scaled = index * (bandCount - 1);
  const int band = std::min(scaled / (kDomainSize - 1), bandCount - 2);
  return {band, static_cast<double>(scaled - band * (kDomainSize - 1)) / (kDomainSize - 1)};
}

void checkBandCount(int bandCount) {
  spectral::requireWithin("bandCount", bandCount, kMinimumBandCount, kConvergedBandCount);
}

}  // namespace

double bandCentreNm(int band, int bandCount) {
  checkBandCount(bandCount);
  spectral::requireWithin("band", band, 0, bandCount - 1);
  return spectral::kDomainStartNm + static_cast<double>(kDomainSize - 1) * band / (bandCount - 1);
}

Eigen::Matrix3Xd bandWeights(const spectral::DomainSamples& light, const Eigen::Matrix<double, kDomainSize, 3>& curves,
                             int bandCount) {
  checkBandCount(bandCount);
  Eigen::Matrix3Xd weights = Eigen::Matrix3Xd::Zero(3, bandCount);
  for (int i = 0; i < kDomainSize; ++i) {
    const BandPosition position = bandPosition(i, bandCount);
    const Eigen::Vector3d sample = light[i] * curves.row(i).transpose();
    weights.col(position.band) += (1.0 - position.fraction) * sample;
    weights.col(position.band + 1) += position.fraction * sample;
  }
  return weights;
}

Eigen::VectorXd atBandCentres(const spectral::DomainSamples& samples, int bandCount) {
  checkBandCount(bandCount);
  Eigen::VectorXd values(bandCount);
  for (int band = 0; band < bandCount; ++band) {
    const double position = static_cast<double>(kDomainSize - 1) * band / (bandCount - 1);
    const int index = std::min(static_cast<int>(position), kDomainSize - 2);
    const double fraction = position - index;
    values[band] = (1.0 - fraction) * samples[index] + fraction * samples[index + 1];
  }
  return values;
}

}  // namespace metamer::sip
