// SPDX-License-Identifier: Apache-2.0
#include "materials/material_table.h"

#include "lights/light_spectrum.h"

namespace metamer::spectral_ref {
namespace {

/// Fresnel reflectance of a conductor averaged over cosine-weighted directions, by cell.
std::vector<float> meanFresnel(const Scene& scene, const Material& material) {
  std::vector<float> means;
  for (int cell = 0; cell < kCells; ++cell) {
    if (material.f0) {
      // Schlick's approximation: the integral of 2 c (1 - c)^5 is 1/21.
      const double f0 = scene.spectra[*material.f0][cell];
      means.push_back(static_cast<float>(f0 + (1.0 - f0) / 21.0));
      continue;
    }
    const Lanes<1> eta = Lanes<1>::Constant(static_cast<float>(scene.spectra[material.eta][cell]));
    const Lanes<1> k = Lanes<1>::Constant(static_cast<float>(scene.spectra[material.absorption][cell]));
    constexpr int kSteps = 64;
    float sum = 0;
    for (int i = 0; i < kSteps; ++i) {
      const float cosine = (static_cast<float>(i) + 0.5F) / kSteps;
      sum += 2.0F * cosine * conductorFresnel<1>(cosine, eta, k)[0] / kSteps;
    }
    means.push_back(sum);
  }
  return means;
}

}  // namespace

MaterialTable::MaterialTable(const Scene& scene) {
  std::vector<std::shared_ptr<const FluorescenceTable>> fluorescences;
  const spectral::ExcitationSamples light = excitingLight(scene);
  for (const spectral::FluorescentSamples& surface : scene.fluorescences) {
    fluorescences.push_back(std::make_shared<FluorescenceTable>(surface, light));
  }
  for (const Material& material : scene.materials) {
    PreparedMaterial prepared;
    prepared.kind = material.kind;
    prepared.colour = material.colour;
    prepared.roughness = static_cast<float>(material.roughness);
    switch (material.kind) {
      case Material::Kind::RoughConductor:
        prepared.hasIndex = !material.f0;
        prepared.eta = material.f0.value_or(material.eta);
        prepared.absorption = material.f0.value_or(material.absorption);
        prepared.energy = GgxEnergy(prepared.roughness);
        prepared.perCell = meanFresnel(scene, material);
        break;
      case Material::Kind::SmoothDielectric:
      case Material::Kind::RoughDielectric:
        prepared.perCell.assign(material.index.perNm.begin(), material.index.perNm.end());
        prepared.isDispersive = !material.index.isConstant;
        m_isDispersive = m_isDispersive || prepared.isDispersive;
        break;
      case Material::Kind::Gel:
        m_hasGels = true;
        if (material.sheetIndex > 0) {
          prepared.sheet = std::make_shared<GelSheet>(scene.whole(material.colour), material.sheetIndex);
        }
        break;
      case Material::Kind::Fluorescent:
        prepared.fluorescence = fluorescences[material.fluorescence];
        break;
      case Material::Kind::Diffuse:
        if (material.texture) {
          prepared.texture = std::make_shared<ReflectanceTexture>(scene.textures[*material.texture]);
        }
        break;
      case Material::Kind::Black:
        break;
    }
    m_materials.push_back(std::move(prepared));
  }
}

}  // namespace metamer::spectral_ref
