// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/illuminants.h"

#include <algorithm>
#include <cmath>

#include "light/planck.h"
#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"

namespace metamer::spectral {
namespace {

constexpr int kStartNm = 300;  // fluorescence is excited from here on
constexpr int kEndNm = 830;
constexpr double kNormalisedAtNm = 560;

// The comparisons also refuse NaN.
void checkTemperature(const char* field, double kelvin, double least, double most) {
  if (!(kelvin >= least && kelvin <= most)) {
    throw InputError("", field, numberText(kelvin) + " K",
                     "must lie between " + numberText(least) + " and " + numberText(most) + " K");
  }
}

/// CIE 015:2018 rounds the two weights to three decimals, and the tables of D50 ... D75 follow from the rounded ones.
double threeDecimals(double value) {
  return std::round(value * 1000.0) / 1000.0;
}

}  // namespace

Spectrum blackbody(double temperatureK) {
  checkTemperature("blackbody temperature", temperatureK, 500, 100000);
  std::vector<double> wavelengths;
  std::vector<double> values;
  const double reference = planckExponentialTerm(kNormalisedAtNm, temperatureK);
  for (int nm = kStartNm; nm <= kEndNm; ++nm) {
    wavelengths.push_back(nm);
    values.push_back(std::pow(kNormalisedAtNm / nm, 5) * reference / planckExponentialTerm(nm, temperatureK));
  }
  return Spectrum(numberText(temperatureK) + " K", SpectralQuantity::SpectralPowerDistribution, std::move(wavelengths),
                  std::move(values))
      .ofFormula();
}

Spectrum daylight(double cctK, const std::vector<Spectrum>& basis) {
  requireAsMany("daylight basis", static_cast<std::int64_t>(basis.size()), "S0, S1, S2", 3);
  checkTemperature("daylight temperature", cctK, 4000, 25000);
  const double m = 1000.0 / cctK;
  const double x = cctK <= 7000 ? -4.6070 * m * m * m + 2.9678 * m * m + 0.09911 * m + 0.244063
                                : -2.0064 * m * m * m + 1.9018 * m * m + 0.24748 * m + 0.237040;
  const double y = -3.000 * x * x + 2.870 * x - 0.275;
  const double divisor = 0.0241 + 0.2562 * x - 0.7341 * y;
  const double m1 = threeDecimals((-1.3515 - 1.7703 * x + 5.9114 * y) / divisor);
  const double m2 = threeDecimals((0.0300 - 31.4424 * x + 30.0717 * y) / divisor);
  const auto power = [&](double nm) {
    return std::max(0.0, basis[0].at(nm) + m1 * basis[1].at(nm) + m2 * basis[2].at(nm));
  };

  std::vector<double> wavelengths;
  std::vector<double> values;
  for (int nm = kStartNm; nm <= kEndNm; nm += 5) {
    wavelengths.push_back(nm);
    values.push_back(power(nm) / power(kNormalisedAtNm));
  }
  return {"daylight " + numberText(cctK) + " K", SpectralQuantity::SpectralPowerDistribution, std::move(wavelengths),
          std::move(values)};
}

}  // namespace metamer::spectral
