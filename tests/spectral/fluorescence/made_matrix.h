// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include "metamer/spectral/reradiation.h"

namespace metamer::spectral {

/// Asymmetric band of a dye (Siano and Metzler 1969, log-normal in wavelength), 1 at its peak. Made, not measured.
inline double dyeBand(double nm, double peakNm, double widthNm, double skew) {
  const double place = 1.0 + (nm - peakNm) * (skew * skew - 1.0) / (widthNm * skew);
  return place <= 0 ? 0.0 : std::exp(-std::log(2.0) * std::pow(std::log(place) / std::log(skew), 2.0));
}

/// Bands 300, 310, ... 780 nm.
inline std::vector<double> madeBands() {
  std::vector<double> nm(49);
  for (std::size_t k = 0; k < nm.size(); ++k) {
    nm[k] = 300.0 + 10.0 * static_cast<double>(k);
  }
  return nm;
}

/// One dye of this yield over a white ground: what it takes is not reflected.
struct MadeDye {
  double excitationNm = 460;
  double emissionNm = 520;
  double yield = 0.8;

  double taken(double nm) const { return 0.7 * dyeBand(nm, excitationNm, 80, 0.7); }
  double given(double nm) const { return dyeBand(nm, emissionNm, 45, 1.6); }
};

/// factors(o, i) of one dye, or of two that share the light.
inline Eigen::MatrixXd madeFactors(const std::vector<MadeDye>& dyes) {
  const std::vector<double> nm = madeBands();
  const auto count = static_cast<Eigen::Index>(nm.size());
  Eigen::MatrixXd factors = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double from = nm[static_cast<std::size_t>(i)];
    factors(i, i) = 0.85;
    for (const MadeDye& dye : dyes) {
      const double taken = dye.taken(from) / static_cast<double>(dyes.size());
      double photons = 0;
      for (const double to : nm) {
        photons += dye.given(to);
      }
      factors(i, i) -= taken;
      for (Eigen::Index o = i + 1; o < count; ++o) {
        const double to = nm[static_cast<std::size_t>(o)];
        factors(o, i) += dye.yield * taken * dye.given(to) / photons * from / to;
      }
    }
  }
  return factors;
}

inline Reradiation madeMatrix(const std::vector<MadeDye>& dyes = {MadeDye{}}) {
  return {"made", madeBands(), madeBands(), madeFactors(dyes)};
}

}  // namespace metamer::spectral
