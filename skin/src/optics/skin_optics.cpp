// SPDX-License-Identifier: Apache-2.0
#include "metamer/skin/skin_optics.h"

#include <utility>

#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/input_error.h"

namespace metamer::skin {
namespace {

// Table 3.1. Concentrations in g/l, molar weights in g/mol.
constexpr double kLn10 = 2.303;
constexpr double kHaemoglobin = 150;
constexpr double kHaemoglobinWeight = 64500;
constexpr double kBilirubin = 0.05;
constexpr double kBilirubinWeight = 584.66;
constexpr double kCaroteneOfEpidermis = 2.1e-4;
constexpr double kCaroteneOfDermis = 7e-5;
constexpr double kCaroteneWeight = 536.8726;

/// Equation 3.1 for a substance of its own: absorption in 1/cm.
Eigen::ArrayXd absorption(const spectral::DataLibrary& library, const char* name, double concentration, double weight,
                          const std::vector<double>& wavelengthsNm) {
  const spectral::Spectrum extinction = library.chromophore(name);
  Eigen::ArrayXd result(static_cast<Eigen::Index>(wavelengthsNm.size()));
  for (std::size_t i = 0; i < wavelengthsNm.size(); ++i) {
    result[static_cast<Eigen::Index>(i)] = kLn10 * concentration / weight * extinction.at(wavelengthsNm[i]);
  }
  return result;
}

}  // namespace

SkinOptics::SkinOptics(const spectral::DataLibrary& library, std::vector<double> wavelengthsNm)
    : m_wavelengthsNm(std::move(wavelengthsNm)) {
  if (m_wavelengthsNm.empty()) {
    throw spectral::InputError("", "wavelengths", "0", "there must be at least one");
  }
  for (const double wavelength : m_wavelengthsNm) {
    spectral::requireWithin("wavelength", wavelength, spectral::kDomainStartNm, spectral::kDomainEndNm);
  }
  const auto of = [&](const char* name, double concentration, double weight) {
    return absorption(library, name, concentration, weight, m_wavelengthsNm);
  };
  const auto count = static_cast<Eigen::Index>(m_wavelengthsNm.size());
  const Eigen::ArrayXd nm = Eigen::Map<const Eigen::ArrayXd>(m_wavelengthsNm.data(), count);
  m_eumelanin = 6.6e11 * nm.pow(-3.33);
  m_pheomelanin = 2.9e15 * nm.pow(-4.75);
  m_baseline = 7.84e8 * nm.pow(-3.255);
  m_epidermisRest = of("beta-carotene", kCaroteneOfEpidermis, kCaroteneWeight) + m_baseline;
  m_bloodRest = of("bilirubin", kBilirubin, kBilirubinWeight) + of("beta-carotene", kCaroteneOfDermis, kCaroteneWeight);
  m_deoxyhaemoglobin = of("deoxyhaemoglobin", kHaemoglobin, kHaemoglobinWeight);
  m_oxyhaemoglobin = of("oxyhaemoglobin", kHaemoglobin, kHaemoglobinWeight);
  // Bashkatov et al. 2011 for skin: a = 36.4 1/cm at 500 nm, Rayleigh's share 0.48, Mie's exponent 0.22.
  m_reducedScattering = 36.4 * (0.48 * (nm / 500).pow(-4) + 0.52 * (nm / 500).pow(-0.22));
  // van Gemert et al. 1989.
  m_anisotropy = 0.62 + 0.29e-3 * nm;
  m_scattering = m_reducedScattering / (1 - m_anisotropy);
}

Eigen::ArrayXd SkinOptics::epidermisAbsorption(const SkinParameters& skin) const {
  return skin.melanin * (skin.eumelanin * m_eumelanin + (1 - skin.eumelanin) * m_pheomelanin) +
         (1 - skin.melanin) * m_epidermisRest;
}

Eigen::ArrayXd SkinOptics::dermisAbsorption(const SkinParameters& skin) const {
  return skin.blood * (skin.deoxyhaemoglobin * m_deoxyhaemoglobin + (1 - skin.deoxyhaemoglobin) * m_oxyhaemoglobin +
                       m_bloodRest) +
         (1 - skin.blood) * m_baseline;
}

}  // namespace metamer::skin
