// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "metamer/skin/skin_model.h"
#include "metamer/skin/skin_parameters.h"
#include "metamer/spectral/data_library.h"
#include "metamer/spectral/spectrum.h"

namespace metamer::skin {

/// How skins are distributed among people: a normal distribution of SkinCoordinates, cut to their ranges; and what the
/// model errs by in the mean. From data/skin_prior.json: fits to 50 people of NIST's reference data set.
///
/// phi_m there is what table 3.1 says, eumelanin's share: fits of the model to the 100 published draws come back to
/// them to the draws' own rounding (5e-5 in reflectance) with a dermis of 2100 um, and to shares of eumelanin whose
/// mean is the prior's. A draw outside is set to the border: 28 of those 100 have a share of 0.001, as a normal
/// distribution of mean 0.18 and deviation 0.30 cut at 0.001 has it.
struct SkinPrior {
  SkinCoordinates mean;
  SkinCoordinates standardDeviation;
  Eigen::Matrix<double, 5, 5> correlation;
  /// Measured skin is (1 + misfit) times the model, in the mean, by band.
  SkinSpectrum misfit;

  /// @throws spectral::InputError where the table is missing or malformed
  static SkinPrior read(const spectral::DataLibrary& library);

  Eigen::Matrix<double, 5, 5> covariance() const;
};

/// Draws skins from the prior: standard deviations from a Mersenne Twister by Box and Muller, correlated, then cut to
/// 0.001 ... 0.999 for fractions and shares, and to the thickness's range. The same seed gives the same skins.
/// @param count  0 ... 1e6
/// @throws spectral::InputError outside that range
std::vector<SkinParameters> sampleSkins(const SkinPrior& prior, int count, std::uint32_t seed);

/// The model's albedo with its mean misfit repaired, never below 0.
SkinSpectrum repaired(const SkinSpectrum& albedo, const SkinPrior& prior);

/// Virtual skins as reflectances at the skin bands: sampleSkins, the model and its repair. Named "skin 0", "skin 1",
/// ... For reference scenes and stages.
/// @throws spectral::InputError as sampleSkins
std::vector<spectral::Spectrum> virtualSkins(const spectral::DataLibrary& library, int count, std::uint32_t seed);

}  // namespace metamer::skin
