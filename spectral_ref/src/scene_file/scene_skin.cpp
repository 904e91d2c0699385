// SPDX-License-Identifier: Apache-2.0
#include "scene_file/scene_skin.h"

#include "metamer/skin/skin_prior.h"
#include "metamer/spectral/spectrum.h"

namespace metamer::spectral_ref {

Material readSkin(const YamlValue& value, SceneSpectra& spectra) {
  const YamlMap section(value, {"melanin", "blood", "thickness", "melanin_type", "deoxygenation"});
  const skin::SkinPrior prior = skin::SkinPrior::read(spectra.library());
  skin::SkinParameters parameters = skin::skinOf(prior.mean);
  const auto read = [&](const char* key, double& parameter, double low, double high) {
    if (const auto given = section.find(key)) {
      parameter = given->number(low, high);
    }
  };
  read("melanin", parameters.melanin, 0, 1);
  read("blood", parameters.blood, 0, 1);
  read("thickness", parameters.thicknessUm, skin::kThinnestEpidermisUm, skin::kThickestEpidermisUm);
  read("melanin_type", parameters.eumelanin, 0, 1);
  read("deoxygenation", parameters.deoxyhaemoglobin, 0, 1);
  const Eigen::VectorXd albedo =
      skin::repaired(skin::SkinModel(spectra.library()).albedo(parameters), prior).cwiseMin(1);
  Material material;
  material.kind = Material::Kind::Diffuse;
  material.colour = spectra.add(spectral::onExcitation(
      {"skin", spectral::SpectralQuantity::Reflectance, skin::skinWavelengths(), {albedo.begin(), albedo.end()}}));
  return material;
}

}  // namespace metamer::spectral_ref
