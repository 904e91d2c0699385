// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "lanes.h"
#include "materials/bsdf.h"
#include "materials/diffuse.h"
#include "metamer/spectral_ref/scene.h"

namespace metamer::spectral_ref {

/// The BSDF at a point for the wavelengths of a path, whichever kind it is.
template <int C, bool kDispersive>
class Bsdf {
 public:
  Bsdf(const Material& material, const SpectrumTables& spectra, const WavelengthSet<C>& wavelengths)
      : m_kind(material.kind), m_diffuse{Lanes<C>::Zero()} {
    if (m_kind == Material::Kind::Diffuse) {
      m_diffuse.reflectance = spectra.at(material.colour, wavelengths);
    }
  }

  bool isBlack(const Vec3& out) const {
    return m_kind == Material::Kind::Black || (m_kind == Material::Kind::Diffuse && out.z() <= 0.0F);
  }
  bool isDelta() const { return m_kind == Material::Kind::SmoothDielectric; }

  BsdfValue<C, kDispersive> evaluate(const Vec3& out, const Vec3& in) const { return m_diffuse.evaluate(out, in); }
  /// @param lobe  gives one more random number where the kind needs it
  template <typename Lobe>
  BsdfSample<C, kDispersive> sample(const Vec3& out, float u, float v, const Lobe&) const {
    return m_diffuse.sample(out, u, v);
  }

 private:
  Material::Kind m_kind;
  DiffuseBsdf<C, kDispersive> m_diffuse;
};

class MaterialTable {
 public:
  explicit MaterialTable(const Scene& scene);

  template <int C, bool kDispersive>
  Bsdf<C, kDispersive> bsdf(std::uint32_t material, const SpectrumTables& spectra,
                            const WavelengthSet<C>& wavelengths) const {
    return {m_materials[material], spectra, wavelengths};
  }
  bool hasGels() const { return m_hasGels; }
  bool isGel(std::uint32_t material) const { return m_materials[material].kind == Material::Kind::Gel; }
  SpectrumId gelTransmittance(std::uint32_t material) const { return m_materials[material].colour; }
  /// Whether any material sends wavelengths different ways.
  bool isDispersive() const { return m_isDispersive; }

 private:
  const std::vector<Material>& m_materials;
  bool m_hasGels = false;
  bool m_isDispersive = false;
};

}  // namespace metamer::spectral_ref
