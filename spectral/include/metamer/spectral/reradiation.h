// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "metamer/spectral/spectrum.h"

/// Surfaces that give light back at other wavelengths than they get it. A diffuse fluorescent surface under irradiance
/// E (W.m^-2.nm^-1) has the radiance L(o) = (R(o) E(o) + integral of P(i, o) E(i) di) / pi, with R its reflectance and
/// P (1/nm), zero for o <= i, its re-radiation.
namespace metamer::spectral {

/// Light that excites is read from here on; what lies below does nothing.
inline constexpr int kExcitationStartNm = 300;
inline constexpr int kExcitationSize = kDomainEndNm - kExcitationStartNm + 1;
/// Where 380 nm lies among 300, 301, ... 780 nm.
inline constexpr int kDomainInExcitation = kDomainStartNm - kExcitationStartNm;

/// Values at 300, 301, ..., 780 nm.
using ExcitationSamples = Eigen::Matrix<double, kExcitationSize, 1>;

/// A spectrum there, as Spectrum::onDomain() has it from 380 nm on: of lights what each nanometre counts for (a line of
/// any width has its energy), zero where their tables end; reflectances hold their end values.
ExcitationSamples onExcitation(const Spectrum& spectrum);

/// A re-radiation matrix (Donaldson 1954) as measured, in bands: under light of E_i in each band of excitation, band o
/// gives back the sum over i of factors(o, i) E_i. So factors(o, i) is P times the step; where both bands are the same
/// it is the reflectance, with what a band's light excites in its own band.
class Reradiation {
 public:
  /// @param name          what messages call it, a file as a rule
  /// @param excitationNm  middles of bands, rising, even steps
  /// @param emissionNm    the same, on the same grid
  /// @param factors       a row an emission, a column an excitation
  ///
  /// Noise, up to 2 % of the largest value, becomes 0 where it is negative or lies below the excitation, and a note.
  /// @throws InputError: no two bands, wavelengths that do not rise, uneven steps (a gap), axes off each other's grid,
  /// what is not finite, emission below its excitation, more light or photons than arrive
  Reradiation(std::string name, std::vector<double> excitationNm, std::vector<double> emissionNm,
              Eigen::MatrixXd factors);

  const std::string& name() const { return m_name; }
  const std::vector<double>& excitationNm() const { return m_excitationNm; }
  const std::vector<double>& emissionNm() const { return m_emissionNm; }
  const Eigen::MatrixXd& factors() const { return m_factors; }
  const std::vector<std::string>& notes() const { return m_notes; }
  double stepNm() const { return m_excitationNm[1] - m_excitationNm[0]; }
  /// Whether an entry is re-radiation: emission above excitation.
  bool isShifted(Eigen::Index emission, Eigen::Index excitation) const;

  /// The diagonal, at the wavelengths that both axes have. @throws InputError where they have fewer than two
  Spectrum reflectance() const;

  /// Of the excitation for which it is largest: what comes back of what arrives.
  struct Balance {
    double energy = 0;
    double photons = 0;
    double nm = 0;  ///< where photons are most
  };
  Balance balance() const;

 private:
  void checkAxes() const;
  void cleanNoise();

  std::string m_name;
  std::vector<double> m_excitationNm;
  std::vector<double> m_emissionNm;
  Eigen::MatrixXd m_factors;
  std::vector<std::string> m_notes;
};

/// A diffuse fluorescent surface by 1 nm.
struct FluorescentSamples {
  ExcitationSamples reflectance = ExcitationSamples::Zero();
  /// P in 1/nm: a row an emission, a column an excitation, 300 ... 780 nm each. Sums over 1 nm stand for integrals.
  Eigen::MatrixXd perNm = Eigen::MatrixXd::Zero(kExcitationSize, kExcitationSize);

  /// Sum of pi L by wavelength for an irradiance.
  ExcitationSamples givenBack(const ExcitationSamples& irradiance) const;
  /// Largest share of arriving energy and photons that comes back, over excitations.
  double mostEnergy() const;
  double mostPhotons() const;
};

/// Linear between the middles of bands, each end's band half a step wide beyond its middle, and nothing outside. What
/// interpolation would put at or below the excitation is given to the same excitation's other emission, photon for
/// photon. Outside its table the reflectance holds its end values, less where that would give back more than arrives.
FluorescentSamples samplesOf(const Reradiation& matrix);

/// XYZ (Y = 1 for the perfect reflector) of a surface under a light.
/// @param curves  of the observer, 380 ... 780 nm
Eigen::Vector3d colourOf(const FluorescentSamples& surface, const ExcitationSamples& light,
                         const Eigen::Matrix<double, kDomainSize, 3>& curves);

}  // namespace metamer::spectral
