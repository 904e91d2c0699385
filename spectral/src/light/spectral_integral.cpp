// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/spectral_integral.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace metamer::spectral {
namespace {

/// Samples of a light this far apart are a printed table's, over a range of this width at least.
constexpr double kTableIntervalNm = 5;
constexpr double kTableRangeNm = 100;
/// Files carry wavelengths to a few decimals.
constexpr double kWholeNm = 1e-6;

bool isWhole(double nm) {
  return std::abs(nm - std::round(nm)) < kWholeNm;
}

/// Gauss-Legendre on 0 ... 1, five places: exact for products of nine lines.
constexpr std::array<double, 5> kPlaces{0.046910077030668, 0.230765344947158, 0.5, 0.769234655052842,
                                        0.953089922969332};
constexpr std::array<double, 5> kWeights{0.118463442528095, 0.239314335249683, 0.284444444444444, 0.239314335249683,
                                         0.118463442528095};

/// A table read at rising wavelengths: what Spectrum::at says, without a search a sample.
class RisingReader {
 public:
  explicit RisingReader(const Spectrum& spectrum) : m_spectrum(spectrum) {}

  double operator()(double nm) {
    const std::vector<double>& knots = m_spectrum.wavelengthsNm();
    if (nm <= knots.front() || nm >= knots.back()) {
      return m_spectrum.at(nm);
    }
    while (knots[m_piece + 1] < nm) {
      ++m_piece;
    }
    const double t = (nm - knots[m_piece]) / (knots[m_piece + 1] - knots[m_piece]);
    return (1.0 - t) * m_spectrum.values()[m_piece] + t * m_spectrum.values()[m_piece + 1];
  }

 private:
  const Spectrum& m_spectrum;
  std::size_t m_piece = 0;
};

void addKnots(const Spectrum& spectrum, std::vector<double>& knots) {
  const std::vector<double>& nm = spectrum.wavelengthsNm();
  const auto first = std::upper_bound(nm.begin(), nm.end(), static_cast<double>(kDomainStartNm));
  const auto last = std::lower_bound(first, nm.end(), static_cast<double>(kDomainEndNm));
  knots.insert(knots.end(), first, last);
}

/// 380, 381, ..., 780 nm and all samples' wavelengths between, each once.
std::vector<double> unionOfKnots(const std::vector<const Spectrum*>& tables) {
  std::vector<double> knots;
  for (int nm = kDomainStartNm; nm <= kDomainEndNm; ++nm) {
    knots.push_back(nm);
  }
  for (const Spectrum* table : tables) {
    addKnots(*table, knots);
  }
  std::sort(knots.begin(), knots.end());
  knots.erase(std::unique(knots.begin(), knots.end()), knots.end());
  return knots;
}

/// Calls add(index, weight, nm) for the two hats at each place of each piece, in rising order.
template <typename Add>
void forEachPlace(const std::vector<double>& knots, const Add& add) {
  for (std::size_t piece = 0; piece + 1 < knots.size(); ++piece) {
    const double start = knots[piece];
    const double width = knots[piece + 1] - start;
    const int hat = std::min(static_cast<int>(std::floor(start)) - kDomainStartNm, kDomainSize - 2);
    for (std::size_t g = 0; g < kPlaces.size(); ++g) {
      const double nm = start + kPlaces[g] * width;
      add(hat, nm - (kDomainStartNm + hat), kWeights[g] * width, nm);
    }
  }
}

}  // namespace

bool isSummed(const Spectrum& spectrum) {
  const std::vector<double>& nm = spectrum.wavelengthsNm();
  const auto isInside = [](double wavelength) { return wavelength > kDomainStartNm && wavelength < kDomainEndNm; };
  if (spectrum.quantity() != SpectralQuantity::SpectralPowerDistribution) {
    return std::all_of(nm.begin(), nm.end(), [&](double each) { return !isInside(each) || isWhole(each); });
  }
  if (spectrum.isOfFormula()) {
    return true;
  }
  const SpectralShape shape = spectrum.shape();
  return shape.intervalNm >= kTableIntervalNm - kWholeNm && shape.endNm - shape.startNm >= kTableRangeNm &&
         std::all_of(nm.begin(), nm.end(), isWhole);
}

DomainSamples lightOnDomain(const Spectrum& light) {
  DomainSamples samples = DomainSamples::Zero();
  if (isSummed(light)) {
    for (int i = 0; i < kDomainSize; ++i) {
      samples[i] = light.at(kDomainStartNm + i);
    }
    return samples;
  }
  RisingReader power(light);
  forEachPlace(unionOfKnots({&light}), [&](int hat, double fraction, double weight, double nm) {
    const double energy = weight * power(nm);
    samples[hat] += (1.0 - fraction) * energy;
    samples[hat + 1] += fraction * energy;
  });
  return samples;
}

SeenLight seenLight(const Spectrum& light, const std::vector<WeighedFilter>& filters, const Observer& observer) {
  SeenLight seen{lightOnDomain(light), observer.onDomain()};
  std::vector<const Spectrum*> tables{&light};
  for (const WeighedFilter& filter : filters) {
    tables.push_back(&filter.transmittance);
  }
  for (const Spectrum& curve : observer.curves) {
    tables.push_back(&curve);
  }
  if (std::all_of(tables.begin(), tables.end(), [](const Spectrum* table) { return isSummed(*table); })) {
    for (const WeighedFilter& filter : filters) {
      seen.light.array() *= filter.transmittance.onDomain().array().max(0.0).pow(filter.density);
    }
    return seen;
  }
  std::vector<RisingReader> readers;
  for (const Spectrum* table : tables) {
    readers.emplace_back(*table);
  }
  Eigen::Matrix<double, kDomainSize, 3> weights = Eigen::Matrix<double, kDomainSize, 3>::Zero();
  seen.light.setZero();
  forEachPlace(unionOfKnots(tables), [&](int hat, double fraction, double weight, double nm) {
    double energy = weight * readers[0](nm);
    for (std::size_t f = 0; f < filters.size(); ++f) {
      energy *= std::pow(std::max(readers[1 + f](nm), 0.0), filters[f].density);
    }
    if (energy == 0.0) {
      return;
    }
    seen.light[hat] += (1.0 - fraction) * energy;
    seen.light[hat + 1] += fraction * energy;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const double response = energy * readers[1 + filters.size() + static_cast<std::size_t>(k)](nm);
      weights(hat, k) += (1.0 - fraction) * response;
      weights(hat + 1, k) += fraction * response;
    }
  });
  for (int i = 0; i < kDomainSize; ++i) {
    if (seen.light[i] > 0.0) {
      seen.curves.row(i) = weights.row(i) / seen.light[i];
    }
  }
  return seen;
}

}  // namespace metamer::spectral
