// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/reradiation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"

namespace metamer::spectral {
namespace {

/// Files carry wavelengths to a few decimals.
constexpr double kSameNm = 1e-3;
/// Instruments of 10 nm bands leave up to 1.5 % of the largest value beside the diagonal.
constexpr double kNoise = 0.02;
/// Sums over many bands may pass 1 by rounding, in single precision too.
constexpr double kMostGain = 1.0 + 1e-5;

std::string nmText(double nm) {
  return numberText(nm) + " nm";
}

void checkRising(const std::string& name, const char* axis, const std::vector<double>& nm) {
  if (nm.size() < 2) {
    throw InputError(name, axis, std::to_string(nm.size()), "must be two wavelengths or more");
  }
  const double step = nm[1] - nm[0];
  for (std::size_t i = 0; i < nm.size(); ++i) {
    if (!std::isfinite(nm[i]) || nm[i] <= 0 || (i > 0 && nm[i] <= nm[i - 1])) {
      throw InputError(name, axis, numberText(nm[i]), "must be above 0 nm and above the one before it");
    }
    if (i > 0 && std::abs(nm[i] - nm[i - 1] - step) > kSameNm) {
      throw InputError(
          name, axis, numberText(nm[i - 1]) + " to " + numberText(nm[i]),
          "is a gap where steps are " + numberText(step) + " nm; fill it in, or resample the matrix evenly");
    }
  }
}

}  // namespace

Reradiation::Reradiation(std::string name, std::vector<double> excitationNm, std::vector<double> emissionNm,
                         Eigen::MatrixXd factors)
    : m_name(std::move(name)),
      m_excitationNm(std::move(excitationNm)),
      m_emissionNm(std::move(emissionNm)),
      m_factors(std::move(factors)) {
  checkAxes();
  cleanNoise();
  const Balance most = balance();
  if (most.photons > kMostGain) {
    throw InputError(
        m_name, "excitation " + nmText(most.nm), formatted("%.4g", most.photons),
        formatted("photons come back for each that arrives (%.4g of the energy); no surface gives more than "
                  "1: %s",
                  most.energy, most.photons > 10 ? "is it in percent?" : "check its scale and its steps"));
  }
}

void Reradiation::checkAxes() const {
  checkRising(m_name, "excitation", m_excitationNm);
  checkRising(m_name, "emission", m_emissionNm);
  const double step = stepNm();
  const double apart = (m_emissionNm[0] - m_excitationNm[0]) / step;
  if (std::abs(m_emissionNm[1] - m_emissionNm[0] - step) > kSameNm ||
      std::abs(apart - std::round(apart)) * step > kSameNm) {
    throw InputError(m_name, "emission", nmText(m_emissionNm[0]),
                     "and on must lie on the grid of the excitation, every " + numberText(step) + " nm from " +
                         nmText(m_excitationNm[0]) + "; resample the matrix");
  }
  if (m_factors.rows() != static_cast<Eigen::Index>(m_emissionNm.size()) ||
      m_factors.cols() != static_cast<Eigen::Index>(m_excitationNm.size())) {
    throw InputError(m_name, "values", std::to_string(m_factors.rows()) + " x " + std::to_string(m_factors.cols()),
                     "must be a row an emission and a column an excitation");
  }
}

bool Reradiation::isShifted(Eigen::Index emission, Eigen::Index excitation) const {
  return m_emissionNm[static_cast<std::size_t>(emission)] >
         m_excitationNm[static_cast<std::size_t>(excitation)] + 0.5 * stepNm();
}

void Reradiation::cleanNoise() {
  const auto at = [this](Eigen::Index o, Eigen::Index i) {
    return nmText(m_excitationNm[static_cast<std::size_t>(i)]) + " to " +
           nmText(m_emissionNm[static_cast<std::size_t>(o)]);
  };
  double most = 0;
  for (Eigen::Index o = 0; o < m_factors.rows(); ++o) {
    for (Eigen::Index i = 0; i < m_factors.cols(); ++i) {
      if (!std::isfinite(m_factors(o, i))) {
        throw InputError(m_name, at(o, i), numberText(m_factors(o, i)), "must be a finite number");
      }
      most = std::max(most, m_factors(o, i));
    }
  }
  int cleaned = 0;
  double largest = 0;
  const double half = 0.5 * stepNm();
  for (Eigen::Index o = 0; o < m_factors.rows(); ++o) {
    for (Eigen::Index i = 0; i < m_factors.cols(); ++i) {
      double& value = m_factors(o, i);
      const bool isBelow =
          m_emissionNm[static_cast<std::size_t>(o)] < m_excitationNm[static_cast<std::size_t>(i)] - half;
      if (value >= 0 && (!isBelow || value == 0)) {
        continue;
      }
      if (value < -kNoise * most) {
        throw InputError(m_name, at(o, i), numberText(value), "must not be negative; set noise to 0");
      }
      if (isBelow && value > kNoise * most) {
        throw InputError(m_name, at(o, i), numberText(value),
                         "is emission below its excitation, which is no fluorescence; check which axis is which");
      }
      largest = std::max(largest, std::abs(value));
      value = 0;
      ++cleaned;
    }
  }
  if (cleaned > 0) {
    m_notes.push_back(
        formatted("%d values below zero or below their excitation, up to %.2g, were set to 0", cleaned, largest));
  }
}

Spectrum Reradiation::reflectance() const {
  std::vector<double> nm;
  std::vector<double> values;
  for (std::size_t o = 0; o < m_emissionNm.size(); ++o) {
    for (std::size_t i = 0; i < m_excitationNm.size(); ++i) {
      if (std::abs(m_emissionNm[o] - m_excitationNm[i]) < kSameNm) {
        nm.push_back(m_emissionNm[o]);
        values.push_back(m_factors(static_cast<Eigen::Index>(o), static_cast<Eigen::Index>(i)));
      }
    }
  }
  if (nm.size() < 2) {
    throw InputError(m_name, "reflectance", std::to_string(nm.size()) + " values",
                     "must be two or more: wavelengths that are excitation and emission");
  }
  return {m_name, SpectralQuantity::Reflectance, std::move(nm), std::move(values)};
}

Reradiation::Balance Reradiation::balance() const {
  Balance most;
  for (std::size_t i = 0; i < m_excitationNm.size(); ++i) {
    double energy = 0;
    double photons = 0;
    for (std::size_t o = 0; o < m_emissionNm.size(); ++o) {
      const double factor = m_factors(static_cast<Eigen::Index>(o), static_cast<Eigen::Index>(i));
      energy += factor;
      photons += factor * m_emissionNm[o] / m_excitationNm[i];
    }
    most.energy = std::max(most.energy, energy);
    if (photons > most.photons) {
      most.photons = photons;
      most.nm = m_excitationNm[i];
    }
  }
  return most;
}

}  // namespace metamer::spectral
