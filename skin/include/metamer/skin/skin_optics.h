// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "metamer/skin/layered_albedo.h"
#include "metamer/skin/skin_parameters.h"
#include "metamer/spectral/data_library.h"

namespace metamer::skin {

/// Absorption coefficients of what is in skin and its scattering, at some wavelengths (section 3.3.2, equations 3.1 to
/// 3.4, table 3.1). All coefficients are 1/cm.
///
/// As corrected: the logarithm of ten stands before every molar extinction (the table has it for haemoglobin alone),
/// and phi_h is the share of haemoglobin without oxygen, as equation 3.3 has it.
class SkinOptics {
 public:
  /// @param wavelengthsNm  380 ... 780, any order, at least one
  /// @throws spectral::InputError outside that range, or where a chromophore's table is missing
  SkinOptics(const spectral::DataLibrary& library, std::vector<double> wavelengthsNm);

  const std::vector<double>& wavelengthsNm() const { return m_wavelengthsNm; }

  /// Equation 3.2: Vm (phi_m eumelanin + (1 - phi_m) pheomelanin) + (1 - Vm) (carotene + baseline).
  Eigen::ArrayXd epidermisAbsorption(const SkinParameters& skin) const;
  /// Equation 3.3: Vb (phi_h deoxy + (1 - phi_h) oxyhaemoglobin + bilirubin + carotene) + (1 - Vb) baseline.
  Eigen::ArrayXd dermisAbsorption(const SkinParameters& skin) const;

  const Eigen::ArrayXd& eumelanin() const { return m_eumelanin; }
  const Eigen::ArrayXd& pheomelanin() const { return m_pheomelanin; }
  /// What the epidermis without melanin absorbs, the dermis without blood, and blood beside its haemoglobin.
  const Eigen::ArrayXd& epidermisRest() const { return m_epidermisRest; }
  const Eigen::ArrayXd& baseline() const { return m_baseline; }
  const Eigen::ArrayXd& bloodRest() const { return m_bloodRest; }
  /// Whole blood of 150 g/l, all of it without or with oxygen.
  const Eigen::ArrayXd& deoxyhaemoglobin() const { return m_deoxyhaemoglobin; }
  const Eigen::ArrayXd& oxyhaemoglobin() const { return m_oxyhaemoglobin; }
  /// Equation 3.4, of both layers, and over (1 - anisotropy).
  const Eigen::ArrayXd& reducedScattering() const { return m_reducedScattering; }
  const Eigen::ArrayXd& scattering() const { return m_scattering; }
  const Eigen::ArrayXd& anisotropy() const { return m_anisotropy; }

 private:
  std::vector<double> m_wavelengthsNm;
  Eigen::ArrayXd m_eumelanin;
  Eigen::ArrayXd m_pheomelanin;
  Eigen::ArrayXd m_epidermisRest;
  Eigen::ArrayXd m_baseline;
  Eigen::ArrayXd m_bloodRest;
  Eigen::ArrayXd m_deoxyhaemoglobin;
  Eigen::ArrayXd m_oxyhaemoglobin;
  Eigen::ArrayXd m_reducedScattering;
  Eigen::ArrayXd m_scattering;
  Eigen::ArrayXd m_anisotropy;
};

}  // namespace metamer::skin
