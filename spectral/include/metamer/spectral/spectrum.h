// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace metamer::spectral {

/// What the numbers of a spectrum measure. It decides what holds outside the measured range.
enum class SpectralQuantity {
  SpectralPowerDistribution,  ///< radiant power per nm, relative or absolute; zero outside its range
  Sensitivity,                ///< observer or camera response per nm; zero outside its range
  Reflectance,                ///< 0 = black, 1 = perfect reflector; end values hold outside
  Transmittance,              ///< 0 = opaque, 1 = clear; end values hold outside
};

/// Regular sampling of a spectrum.
struct SpectralShape {
  double startNm = 0;
  double endNm = 0;
  double intervalNm = 0;  ///< 0 where the sampling is irregular
};

/// The domain of every integral: 380, 381, ..., 780 nm. An integral is a sum over these: of samples of curves and
/// surfaces, times what each nanometre of a light counts for (spectral_integral.h).
inline constexpr int kDomainStartNm = 380;
inline constexpr int kDomainEndNm = 780;
inline constexpr int kDomainSize = kDomainEndNm - kDomainStartNm + 1;

/// Values at 380, 381, ..., 780 nm.
using DomainSamples = Eigen::Matrix<double, kDomainSize, 1>;

/// A sampled spectrum: immutable, wavelengths strictly rising, values finite.
class Spectrum {
 public:
  /// @param name           what messages and certificates call it
  /// @param wavelengthsNm  strictly rising, at least two, finite and positive
  /// @param values         as many, finite; non-negative unless the quantity is Sensitivity
  /// @throws InputError where a condition does not hold (names the wavelength and the value)
  Spectrum(std::string name, SpectralQuantity quantity, std::vector<double> wavelengthsNm, std::vector<double> values);

  const std::string& name() const { return m_name; }
  SpectralQuantity quantity() const { return m_quantity; }
  const std::vector<double>& wavelengthsNm() const { return m_wavelengthsNm; }
  const std::vector<double>& values() const { return m_values; }
  SpectralShape shape() const;

  /// What a reader changed, and what its file lacks: for certificates and messages, without the name.
  const std::vector<std::string>& notes() const { return m_notes; }
  Spectrum withNotes(std::vector<std::string> notes) const;

  /// Whether the samples are a smooth formula's and no measured table: their sum is its integral.
  bool isOfFormula() const { return m_isOfFormula; }
  Spectrum ofFormula() const;

  /// Value at one wavelength: linear between samples, outside as SpectralQuantity says.
  double at(double wavelengthNm) const;

  /// Values on the 1 nm integration domain; of a light, what each nanometre counts for (see lightOnDomain).
  DomainSamples onDomain() const;

 private:
  std::string m_name;
  SpectralQuantity m_quantity;
  std::vector<double> m_wavelengthsNm;
  std::vector<double> m_values;
  std::vector<std::string> m_notes;
  bool m_isOfFormula = false;
};

}  // namespace metamer::spectral
