// SPDX-License-Identifier: Apache-2.0
#include "fluorescence/fluorescent_samples.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "metamer/spectral/reradiation.h"
#include "metamer/spectral/spectral_integral.h"

namespace metamer::spectral {
namespace {

/// Gauss-Legendre on 0 ... 1, two places: exact for a line times a line.
constexpr double kPlaces[] = {0.211324865405187, 0.788675134594813};

/// Integrals of hats times a light below 380 nm. The last hat, at 379 nm, keeps what lies up to 380.
void addBelowDomain(const Spectrum& light, ExcitationSamples& samples) {
  std::vector<double> knots;
  for (int nm = kExcitationStartNm; nm <= kDomainStartNm; ++nm) {
    knots.push_back(nm);
  }
  for (const double nm : light.wavelengthsNm()) {
    if (nm > kExcitationStartNm && nm < kDomainStartNm) {
      knots.push_back(nm);
    }
  }
  std::sort(knots.begin(), knots.end());
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
    const double width = knots[k + 1] - knots[k];
    for (const double place : kPlaces) {
      const double nm = knots[k] + place * width;
      const double energy = 0.5 * width * light.at(nm);
      const int cell = std::min(static_cast<int>(nm) - kExcitationStartNm, kDomainInExcitation - 1);
      const double fraction = cell + 1 < kDomainInExcitation ? nm - (kExcitationStartNm + cell) : 0.0;
      samples[cell] += (1.0 - fraction) * energy;
      samples[cell + (fraction > 0 ? 1 : 0)] += fraction * energy;
    }
  }
}

/// Weights of two neighbouring bands at a wavelength.
struct Place {
  Eigen::Index band = 0;
  double first = 0;
  double second = 0;
};

/// Linear between middles; half a step beyond the ends their band alone, half of it at its very edge.
Place placeOn(const std::vector<double>& middles, double nm) {
  const double step = middles[1] - middles[0];
  const double last = static_cast<double>(middles.size() - 1);
  const double position = (nm - middles[0]) / step;
  const double outside = std::max(-position, position - last);
  const double share = outside > 0.5 + 1e-9 ? 0.0 : outside > 0.5 - 1e-9 ? 0.5 : 1.0;
  const double within = std::clamp(position, 0.0, last);
  const double band = std::min(std::floor(within), last - 1.0);
  return {static_cast<Eigen::Index>(band), share * (1.0 - (within - band)), share * (within - band)};
}

}  // namespace

ExcitationSamples onExcitation(const Spectrum& spectrum) {
  ExcitationSamples samples = ExcitationSamples::Zero();
  samples.tail<kDomainSize>() = spectrum.onDomain();
  if (spectrum.quantity() == SpectralQuantity::SpectralPowerDistribution && !isSummed(spectrum)) {
    addBelowDomain(spectrum, samples);
    return samples;
  }
  for (int i = 0; i < kDomainInExcitation; ++i) {
    samples[i] = spectrum.at(kExcitationStartNm + i);
  }
  return samples;
}

ExcitationSamples FluorescentSamples::givenBack(const ExcitationSamples& irradiance) const {
  return reflectance.cwiseProduct(irradiance) + perNm * irradiance;
}

double FluorescentSamples::mostEnergy() const {
  return (perNm.colwise().sum().transpose() + reflectance).maxCoeff();
}

double FluorescentSamples::mostPhotons() const {
  return (photonsShifted(*this) + reflectance).maxCoeff();
}

ExcitationSamples photonsShifted(const FluorescentSamples& surface) {
  const ExcitationSamples nm = ExcitationSamples::LinSpaced(kExcitationStartNm, kDomainEndNm);
  return (surface.perNm.transpose() * nm).cwiseQuotient(nm);
}

void keepBalance(FluorescentSamples& surface) {
  const ExcitationSamples shifted = photonsShifted(surface);
  for (int i = 0; i < kExcitationSize; ++i) {
    if (shifted[i] > 1.0) {
      surface.perNm.col(i) /= shifted[i];
    }
    surface.reflectance[i] = std::min(surface.reflectance[i], std::max(0.0, 1.0 - shifted[i]));
  }
}

FluorescentSamples samplesOf(const Reradiation& matrix) {
  FluorescentSamples samples;
  samples.reflectance = onExcitation(matrix.reflectance());
  Eigen::MatrixXd shifted = matrix.factors() / matrix.stepNm();
  for (Eigen::Index o = 0; o < shifted.rows(); ++o) {
    for (Eigen::Index i = 0; i < shifted.cols(); ++i) {
      shifted(o, i) = matrix.isShifted(o, i) ? shifted(o, i) : 0.0;
    }
  }
  for (int i = 0; i < kExcitationSize; ++i) {
    const Place from = placeOn(matrix.excitationNm(), kExcitationStartNm + i);
    double wanted = 0;
    double kept = 0;
    for (int o = 0; o < kExcitationSize; ++o) {
      const int nm = kExcitationStartNm + o;
      const Place to = placeOn(matrix.emissionNm(), nm);
      const auto onEmission = [&](Eigen::Index band) {
        return to.first * shifted(to.band, band) + to.second * shifted(to.band + 1, band);
      };
      const double value = from.first * onEmission(from.band) + from.second * onEmission(from.band + 1);
      wanted += value * nm;
      if (o > i) {
        samples.perNm(o, i) = value;
        kept += value * nm;
      }
    }
    if (kept > 0) {
      samples.perNm.col(i) *= wanted / kept;
    }
  }
  keepBalance(samples);
  return samples;
}

Eigen::Vector3d colourOf(const FluorescentSamples& surface, const ExcitationSamples& light,
                         const Eigen::Matrix<double, kDomainSize, 3>& curves) {
  const double white = curves.col(1).dot(light.tail<kDomainSize>());
  return curves.transpose() * surface.givenBack(light).tail<kDomainSize>() / white;
}

double integralOf(const Spectrum& spectrum) {
  const std::vector<double>& nm = spectrum.wavelengthsNm();
  double sum = 0;
  for (std::size_t i = 0; i + 1 < nm.size(); ++i) {
    sum += 0.5 * (nm[i + 1] - nm[i]) * (spectrum.values()[i] + spectrum.values()[i + 1]);
  }
  return sum;
}

}  // namespace metamer::spectral
