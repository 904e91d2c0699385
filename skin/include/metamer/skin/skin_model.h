// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "metamer/skin/layered_albedo.h"
#include "metamer/skin/skin_optics.h"
#include "metamer/skin/skin_parameters.h"
#include "metamer/spectral/data_library.h"

namespace metamer::skin {

/// Bands of a skin's spectrum: 380, 390, ..., 780 nm (section 3.2: 10 nm is enough).
inline constexpr int kSkinBands = 41;
inline constexpr double kSkinBandNm = 10;
using SkinSpectrum = Eigen::Matrix<double, kSkinBands, 1>;
/// Those wavelengths.
std::vector<double> skinWavelengths();

/// Table 3.2. The prior was fitted with it; the chapter's text has an infinite dermis, brighter by 0.017 at 780 nm.
inline constexpr double kDermisThicknessCm = 0.21;

/// The forward model: parameters to the albedo under diffuse light at some wavelengths (sections 3.3 and 3.4), solved
/// by adding-doubling. No surface: its reflection is added outside. Immutable.
class SkinModel {
 public:
  /// @param wavelengthsNm      380 ... 780
  /// @param dermisThicknessCm  above 0, may be infinite
  /// @throws spectral::InputError outside those ranges
  explicit SkinModel(const spectral::DataLibrary& library, std::vector<double> wavelengthsNm = skinWavelengths(),
                     double dermisThicknessCm = kDermisThicknessCm);

  const SkinOptics& optics() const { return m_optics; }
  double dermisThicknessCm() const { return m_dermisThicknessCm; }

  /// The two layers at each wavelength. @throws spectral::InputError where requireSkin does
  std::vector<LayerOptics> layers(const SkinParameters& skin) const;
  /// The albedo at each wavelength, 0 ... 1. @throws spectral::InputError where requireSkin does
  Eigen::VectorXd albedo(const SkinParameters& skin) const;

 private:
  SkinOptics m_optics;
  double m_dermisThicknessCm;
};

}  // namespace metamer::skin
