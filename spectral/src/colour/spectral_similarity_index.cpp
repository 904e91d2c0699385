// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/spectral_similarity_index.h"

#include <Eigen/Core>
#include <cmath>

namespace metamer::spectral {
namespace {

constexpr int kFirstCentreNm = 380;
constexpr int kBandNm = 10;
constexpr int kBands = 30;
using Bands = Eigen::Matrix<double, kBands, 1>;

/// Trapezium-rule integrals over 10 nm centred on 380, 390, ..., 670 nm, scaled to a sum of one.
Bands normalisedBands(const Spectrum& light) {
  Bands bands = Bands::Zero();
  for (int band = 0; band < kBands; ++band) {
    const int first = kFirstCentreNm + band * kBandNm - kBandNm / 2;
    for (int i = 0; i <= kBandNm; ++i) {
      const double weight = i == 0 || i == kBandNm ? 0.5 : 1.0;
      bands[band] += weight * light.at(first + i);
    }
  }
  const double sum = bands.sum();
  return sum > 0 ? Bands(bands / sum) : bands;
}

/// Spectral weights of ST 2122:2020, table 1: one but for the ends of the visible range.
double bandWeight(int band) {
  switch (band) {
    case 0:
      return 12.0 / 45.0;
    case 1:
      return 22.0 / 45.0;
    case 2:
      return 32.0 / 45.0;
    case 3:
      return 40.0 / 45.0;
    case 4:
      return 44.0 / 45.0;
    case kBands - 2:
      return 11.0 / 15.0;
    case kBands - 1:
      return 3.0 / 15.0;
    default:
      return 1.0;
  }
}

}  // namespace

double spectralSimilarityIndex(const Spectrum& light, const Spectrum& reference, bool rounded) {
  const Bands lightBands = normalisedBands(light);
  const Bands referenceBands = normalisedBands(reference);
  Bands difference;
  for (int band = 0; band < kBands; ++band) {
    // One thirtieth is the mean band: it keeps bands without reference power from dominating.
    difference[band] =
        bandWeight(band) * (lightBands[band] - referenceBands[band]) / (referenceBands[band] + 1.0 / kBands);
  }
  double sumOfSquares = 0;
  for (int band = 0; band < kBands; ++band) {
    const double before = band > 0 ? difference[band - 1] : 0;
    const double after = band + 1 < kBands ? difference[band + 1] : 0;
    const double smoothed = 0.22 * before + 0.56 * difference[band] + 0.22 * after;
    sumOfSquares += smoothed * smoothed;
  }
  const double index = 100.0 - 32.0 * std::sqrt(sumOfSquares);
  return rounded ? std::nearbyint(index) : index;
}

}  // namespace metamer::spectral
