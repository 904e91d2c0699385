// SPDX-License-Identifier: Apache-2.0
#include "material_table.h"

namespace metamer::spectral_ref {

MaterialTable::MaterialTable(const Scene& scene) : m_materials(scene.materials) {
  for (const Material& material : m_materials) {
    m_hasGels = m_hasGels || material.kind == Material::Kind::Gel;
    const bool refracts =
        material.kind == Material::Kind::SmoothDielectric || material.kind == Material::Kind::RoughDielectric;
    m_isDispersive = m_isDispersive || (refracts && !material.index.isConstant);
  }
}

}  // namespace metamer::spectral_ref
