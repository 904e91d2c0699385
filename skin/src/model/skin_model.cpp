// SPDX-License-Identifier: Apache-2.0
#include "metamer/skin/skin_model.h"

#include <limits>
#include <utility>

#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"

namespace metamer::skin {

std::vector<double> skinWavelengths() {
  std::vector<double> wavelengths;
  for (int band = 0; band < kSkinBands; ++band) {
    wavelengths.push_back(spectral::kDomainStartNm + kSkinBandNm * band);
  }
  return wavelengths;
}

SkinModel::SkinModel(const spectral::DataLibrary& library, std::vector<double> wavelengthsNm, double dermisThicknessCm)
    : m_optics(library, std::move(wavelengthsNm)), m_dermisThicknessCm(dermisThicknessCm) {
  // Infinite is allowed, so not requireAbove.
  if (!(dermisThicknessCm > 0)) {
    throw spectral::InputError("", "dermis thickness", spectral::numberText(dermisThicknessCm), "must be above 0");
  }
}

std::vector<LayerOptics> SkinModel::layers(const SkinParameters& skin) const {
  requireSkin(skin);
  const Eigen::ArrayXd epidermis = m_optics.epidermisAbsorption(skin);
  const Eigen::ArrayXd dermis = m_optics.dermisAbsorption(skin);
  std::vector<LayerOptics> result(m_optics.wavelengthsNm().size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    result[i] = {epidermis[at],           dermis[at],         m_optics.scattering()[at], m_optics.anisotropy()[at],
                 skin.thicknessUm * 1e-4, m_dermisThicknessCm};
  }
  return result;
}

Eigen::VectorXd SkinModel::albedo(const SkinParameters& skin) const {
  const std::vector<LayerOptics> at = layers(skin);
  Eigen::VectorXd result(static_cast<Eigen::Index>(at.size()));
  layeredAlbedos(at, {result.data(), at.size()});
  return result;
}

}  // namespace metamer::skin
