// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "materials/bsdf.h"
#include "materials/conductor.h"
#include "materials/dielectric.h"
#include "materials/diffuse.h"
#include "materials/fluorescence_table.h"
#include "materials/gel_sheet.h"
#include "materials/reflectance_texture.h"
#include "metamer/spectral_ref/scene.h"
#include "wavelengths/lanes.h"

namespace metamer::spectral_ref {

/// A material with what is worked out once.
struct PreparedMaterial {
  Material::Kind kind = Material::Kind::Black;
  SpectrumId colour = 0;
  SpectrumId eta = 0;
  SpectrumId absorption = 0;
  bool hasIndex = false;
  bool isDispersive = false;
  float roughness = 0;
  GgxEnergy energy;
  std::vector<float> perCell;  ///< conductor: mean Fresnel reflectance; dielectric: index
  std::shared_ptr<const FluorescenceTable> fluorescence;
  std::shared_ptr<const GelSheet> sheet;  ///< of a gel that depends on the angle
  std::shared_ptr<const ReflectanceTexture> texture;
};

/// The BSDF at a point for the wavelengths of a path, whichever kind it is.
template <int C, bool kDispersive>
class Bsdf {
 public:
  Bsdf(const PreparedMaterial& material, const SpectrumTables& spectra, const WavelengthSet<C>& wavelengths)
      : m_kind(material.kind) {
    switch (m_kind) {
      case Material::Kind::Diffuse:
      case Material::Kind::Fluorescent:
        m_diffuse.reflectance = spectra.at(material.colour, wavelengths);
        break;
      case Material::Kind::RoughConductor:
        m_conductor.ggx.alpha = material.roughness;
        m_conductor.energy = &material.energy;
        m_conductor.isIndex = material.hasIndex;
        m_conductor.eta = spectra.at(material.eta, wavelengths);
        m_conductor.k = spectra.at(material.absorption, wavelengths);
        m_conductor.mean = fromCells(material, wavelengths);
        break;
      case Material::Kind::SmoothDielectric:
      case Material::Kind::RoughDielectric:
        m_dielectric.index = fromCells(material, wavelengths);
        m_dielectric.isDispersive = material.isDispersive;
        m_dielectric.isRough = m_kind == Material::Kind::RoughDielectric;
        m_dielectric.ggx.alpha = material.roughness;
        break;
      case Material::Kind::Black:
      case Material::Kind::Gel:
        break;
    }
  }

  bool isBlack(const Vec3& out) const {
    switch (m_kind) {
      case Material::Kind::Diffuse:
      case Material::Kind::Fluorescent:
      case Material::Kind::RoughConductor:
        return out.z() <= 0.0F;
      case Material::Kind::SmoothDielectric:
      case Material::Kind::RoughDielectric:
        return false;
      case Material::Kind::Black:
      case Material::Kind::Gel:
        break;
    }
    return true;
  }
  bool isDelta() const { return m_kind == Material::Kind::SmoothDielectric; }
  /// Whether it scatters light from behind as well.
  bool isTwoSided() const { return m_kind == Material::Kind::RoughDielectric; }
  const Lanes<C>& diffuseReflectance() const { return m_diffuse.reflectance; }
  /// Of a fluorescent surface, once it is chosen what becomes of the lanes; of a texture, once it is known where.
  void setDiffuseReflectance(const Lanes<C>& reflectance) { m_diffuse.reflectance = reflectance; }

  /// Directions in the frame of the surface, both away from it.
  BsdfValue<C, kDispersive> evaluate(const Vec3& out, const Vec3& in) const {
    switch (m_kind) {
      case Material::Kind::RoughConductor:
        return m_conductor.evaluate(out, in);
      case Material::Kind::RoughDielectric:
        return m_dielectric.evaluate(out, in);
      default:
        return m_diffuse.evaluate(out, in);
    }
  }
  /// @param lobe  gives one more random number where the kind needs it
  template <typename Lobe>
  BsdfSample<C, kDispersive> sample(const Vec3& out, float u, float v, const Lobe& lobe) const {
    switch (m_kind) {
      case Material::Kind::RoughConductor:
        return m_conductor.sample(out, u, v, lobe());
      case Material::Kind::SmoothDielectric:
      case Material::Kind::RoughDielectric:
        return m_dielectric.sample(out, u, v, lobe());
      default:
        return m_diffuse.sample(out, u, v);
    }
  }

 private:
  static Lanes<C> fromCells(const PreparedMaterial& material, const WavelengthSet<C>& wavelengths) {
    Lanes<C> values;
    for (int k = 0; k < C; ++k) {
      // In the ultraviolet glass and metal are as at 380 nm.
      values[k] =
          material.perCell[static_cast<std::size_t>(std::max(wavelengths.cell[static_cast<std::size_t>(k)], 0))];
    }
    return values;
  }

  Material::Kind m_kind;
  DiffuseBsdf<C, kDispersive> m_diffuse;
  ConductorBsdf<C, kDispersive> m_conductor;
  DielectricBsdf<C, kDispersive> m_dielectric;
};

class MaterialTable {
 public:
  explicit MaterialTable(const Scene& scene);

  template <int C, bool kDispersive>
  Bsdf<C, kDispersive> bsdf(std::uint32_t material, const SpectrumTables& spectra,
                            const WavelengthSet<C>& wavelengths) const {
    return {m_materials[material], spectra, wavelengths};
  }
  /// Whether all light is given back as Lambert's law says, at its own wavelength, everywhere alike: its reflectance is
  /// colour().
  bool isPlain(std::uint32_t material) const {
    return m_materials[material].kind == Material::Kind::Diffuse && !m_materials[material].texture;
  }
  SpectrumId colour(std::uint32_t material) const { return m_materials[material].colour; }
  /// Whether all light is given back as Lambert's law says, at its own wavelength or another.
  bool isDiffuse(std::uint32_t material) const {
    return m_materials[material].kind == Material::Kind::Diffuse ||
           m_materials[material].kind == Material::Kind::Fluorescent;
  }
  /// Null where the material keeps wavelengths.
  const FluorescenceTable* fluorescence(std::uint32_t material) const {
    return m_materials[material].fluorescence.get();
  }
  /// Null where the material is everywhere alike.
  const ReflectanceTexture* texture(std::uint32_t material) const { return m_materials[material].texture.get(); }
  bool hasGels() const { return m_hasGels; }
  bool isGel(std::uint32_t material) const { return m_materials[material].kind == Material::Kind::Gel; }
  /// What a gel passes. @param cosine  of the ray to the gel's normal
  template <int C>
  Lanes<C> gelTransmittance(std::uint32_t material, float cosine, const SpectrumTables& spectra,
                            const WavelengthSet<C>& wavelengths) const {
    const PreparedMaterial& gel = m_materials[material];
    return gel.sheet ? gel.sheet->transmittance<C>(cosine, wavelengths) : spectra.at(gel.colour, wavelengths);
  }
  /// Whether any material sends wavelengths different ways.
  bool isDispersive() const { return m_isDispersive; }

 private:
  std::vector<PreparedMaterial> m_materials;
  bool m_hasGels = false;
  bool m_isDispersive = false;
};

}  // namespace metamer::spectral_ref
