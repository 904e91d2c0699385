// SPDX-License-Identifier: Apache-2.0
#include "scene_file/scene_surface.h"

#include <cmath>

#include "materials/gel_sheet.h"
#include "scene_file/scene_fluorescence.h"
#include "scene_file/scene_skin.h"
#include "scene_file/scene_texture.h"

namespace metamer::spectral_ref {
namespace {

using Use = SceneSpectra::Use;

/// An index this close to 1 and no closer bends light; beyond 4 nothing transparent is known in the visible range.
constexpr double kLowestIndex = 1.0;
constexpr double kHighestIndex = 4.0;

std::vector<double> onCells(const YamlValue& value, double (*formula)(const std::vector<double>&, double),
                            const std::vector<double>& coefficients) {
  std::vector<double> index;
  for (int i = 0; i < spectral::kDomainSize; ++i) {
    const double micrometres = (spectral::kDomainStartNm + i) * 1e-3;
    index.push_back(formula(coefficients, micrometres));
    if (!(index.back() >= kLowestIndex && index.back() <= kHighestIndex)) {
      throw value.error("", "the index at " + std::to_string(spectral::kDomainStartNm + i) + " nm is " +
                                std::to_string(index.back()) + "; it must lie between 1 and 4 from 380 to 780 nm");
    }
  }
  return index;
}

double cauchy(const std::vector<double>& c, double micrometres) {
  const double square = micrometres * micrometres;
  double n = c[0];
  double power = 1.0;
  for (std::size_t i = 1; i < c.size(); ++i) {
    power *= square;
    n += c[i] / power;
  }
  return n;
}

double sellmeier(const std::vector<double>& c, double micrometres) {
  const double square = micrometres * micrometres;
  double n2 = 1.0;
  for (std::size_t i = 0; i + 1 < c.size(); i += 2) {
    n2 += c[i] * square / (square - c[i + 1]);
  }
  return n2 > 0 ? std::sqrt(n2) : 0.0;
}

RefractiveIndex readIndex(const YamlValue& value, SceneSpectra& spectra, const Scene& scene) {
  RefractiveIndex index;
  if (value.isNumber()) {
    index.perNm.assign(spectral::kDomainSize, value.number(kLowestIndex, kHighestIndex));
    return index;
  }
  index.isConstant = false;
  if (value.isMap()) {
    const YamlMap section(value, {"cauchy", "sellmeier"});
    if (const auto coefficients = section.find("cauchy")) {
      const auto numbers = coefficients->numbers();
      if (numbers.empty() || numbers.size() > 4) {
        throw coefficients->error("", "must be one to four coefficients [A, B, C, D], n = A + B/l^2 + ..., l in um");
      }
      index.perNm = onCells(*coefficients, cauchy, numbers);
      return index;
    }
    const auto coefficients =
        section.require("sellmeier", "is missing; give sellmeier: [[B1, C1], ...] (um^2) or cauchy: [A, B, ...]");
    std::vector<double> numbers;
    for (const YamlValue& pair : coefficients.items()) {
      const auto both = pair.numbers();
      if (both.size() != 2) {
        throw pair.error("", "must be a pair [B, C], C in um^2");
      }
      numbers.insert(numbers.end(), both.begin(), both.end());
    }
    index.perNm = onCells(coefficients, sellmeier, numbers);
    return index;
  }
  const auto& samples = scene.spectra[spectra.find(value, Use::Refraction)];
  if (!(samples.minCoeff() >= kLowestIndex && samples.maxCoeff() <= kHighestIndex)) {
    throw value.error("must be an index between 1 and 4 from 380 to 780 nm");
  }
  index.perNm.assign(samples.data(), samples.data() + samples.size());
  index.isConstant = samples.minCoeff() == samples.maxCoeff();
  return index;
}

double readRoughness(const YamlMap& section) {
  const auto roughness = section.find("roughness");
  return roughness ? roughness->number(0.0, 1.0) : 0.0;
}

/// Below this GGX is a mirror to single precision.
constexpr double kLeastRoughness = 1e-3;

Material readConductor(const YamlValue& value, SceneSpectra& spectra) {
  const YamlMap section(value, {"eta", "k", "reflectance", "roughness"});
  Material material;
  material.kind = Material::Kind::RoughConductor;
  material.roughness =
      section.require("roughness", "is missing; GGX alpha from 0.001 to 1").number(kLeastRoughness, 1.0);
  if (const auto reflectance = section.find("reflectance")) {
    material.f0 = spectra.find(*reflectance, Use::Reflectance);
    if (section.find("eta") || section.find("k")) {
      throw section.error("", "has both a reflectance and eta, k; keep one");
    }
    return material;
  }
  const char* remedy = "is missing; give the index as eta and k, or reflectance (at normal incidence)";
  material.eta = spectra.find(section.require("eta", remedy), Use::Refraction);
  material.absorption = spectra.find(section.require("k", remedy), Use::Extinction);
  return material;
}

Material readDielectric(const YamlValue& value, SceneSpectra& spectra, const Scene& scene) {
  const YamlMap section(value, {"index", "roughness"});
  Material material;
  material.index = readIndex(section.require("index", "is missing; such as index: 1.5"), spectra, scene);
  material.roughness = readRoughness(section);
  material.kind = Material::Kind::SmoothDielectric;
  if (material.roughness > 0) {
    material.kind = Material::Kind::RoughDielectric;
    material.roughness = std::max(material.roughness, kLeastRoughness);
  }
  return material;
}

/// Lambert's reflector: a reflectance, or a picture of them.
Material readDiffuse(const YamlValue& value, const Texture& place, SceneSpectra& spectra, Scene& scene) {
  if (value.isMap()) {
    return readTexturedDiffuse(value, place, spectra, scene);
  }
  Material material;
  material.kind = Material::Kind::Diffuse;
  material.colour = spectra.find(value, Use::Reflectance);
  return material;
}

/// A gel: a transmittance, or one with the index of its sheet.
Material readGel(const YamlValue& value, SceneSpectra& spectra, const Scene& scene) {
  Material material;
  material.kind = Material::Kind::Gel;
  if (!value.isMap()) {
    material.colour = spectra.find(value, Use::Transmittance);
    return material;
  }
  const YamlMap section(value, {"transmittance", "index"});
  const YamlValue colour = section.require("transmittance", "is missing; name the gel's spectrum");
  material.colour = spectra.find(colour, Use::Transmittance);
  material.sheetIndex =
      section.require("index", "is missing; such as index: 1.49, or 'gel: NAME' for one that knows no angle")
          .number(kLowestIndex, kHighestIndex);
  const double clear = clearSheet(material.sheetIndex);
  const double most = scene.spectra[material.colour].maxCoeff();
  if (most > clear) {
    throw colour.error("", "passes " + std::to_string(most) + " somewhere, more than the " + std::to_string(clear) +
                               " of a clear sheet of this index; lower the index, or say 'gel: NAME'");
  }
  return material;
}

}  // namespace

std::uint32_t addDiffuse(Scene& scene, SpectrumId reflectance) {
  Material material;
  material.kind = Material::Kind::Diffuse;
  material.colour = reflectance;
  scene.materials.push_back(material);
  return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

Surface readSurface(const YamlMap& shape, const Texture& place, SceneSpectra& spectra, Scene& scene) {
  Surface surface;
  std::optional<Material> material;
  const auto set = [&](const YamlValue& value, const Material& given) {
    if (material) {
      throw value.error("", "the shape has another material already; keep one");
    }
    material = given;
  };
  if (const auto diffuse = shape.find("diffuse")) {
    set(*diffuse, readDiffuse(*diffuse, place, spectra, scene));
  }
  if (const auto skin = shape.find("skin")) {
    set(*skin, readSkin(*skin, spectra));
  }
  if (const auto fluorescent = shape.find("fluorescent")) {
    set(*fluorescent, readFluorescent(*fluorescent, spectra, scene));
  }
  if (const auto gel = shape.find("gel")) {
    set(*gel, readGel(*gel, spectra, scene));
  }
  if (const auto conductor = shape.find("conductor")) {
    set(*conductor, readConductor(*conductor, spectra));
  }
  if (const auto dielectric = shape.find("dielectric")) {
    set(*dielectric, readDielectric(*dielectric, spectra, scene));
  }
  if (const auto emission = shape.find("emission")) {
    if (material && material->kind == Material::Kind::Gel) {
      throw emission->error("a gel has no light of its own; leave the emission out");
    }
    const SpectrumId id = spectra.find(*emission, Use::Emission);
    surface.emission = Emission{id};
  }
  if (!material && !surface.emission) {
    throw shape.error("", "has no material; give diffuse, skin, fluorescent, conductor, dielectric, gel or emission");
  }
  scene.materials.push_back(material.value_or(Material{}));
  surface.material = static_cast<std::uint32_t>(scene.materials.size() - 1);
  return surface;
}

}  // namespace metamer::spectral_ref
