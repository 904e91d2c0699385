// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "metamer/skin/skin_model.h"

namespace metamer::skin {

/// The forward model at the skin bands as a table, for spectra in less than a microsecond. At one wavelength the albedo
/// depends on the epidermis's absorption, the dermis's and the thickness alone: a table a band over these, read
/// linearly. Immutable, 2.6 MB.
class SkinTable {
 public:
  /// Solves the table's knots: a tenth of a second. @param model  at the skin bands
  /// @throws spectral::InputError for a model of other wavelengths
  explicit SkinTable(const SkinModel& model);

  /// The albedo of each band, within 1e-3 root mean square of the model.
  /// @throws spectral::InputError where requireSkin does
  SkinSpectrum albedo(const SkinParameters& skin) const;

 private:
  static constexpr int kPaddedBands = 44;
  using Bands = Eigen::Array<float, kPaddedBands, 1>;

  /// Where each band lies along the table's three axes.
  Bands m_eumelanin, m_pheomelanin, m_epidermisRest;
  Bands m_deoxyhaemoglobin, m_oxyhaemoglobin, m_bloodRest, m_baseline;
  Bands m_reducedScattering;
  Bands m_dermisStart, m_dermisScale;
  std::vector<float> m_knots;  ///< by band, thickness, absorption of the epidermis, and of the dermis
};

}  // namespace metamer::skin
