// SPDX-License-Identifier: Apache-2.0
#include "lights/light_choice.h"

namespace metamer::spectral_ref {

LightChoice::LightChoice(const LightTable& lights, const LightTree* tree) : m_lights(lights), m_tree(tree) {
  if (m_tree != nullptr && m_tree->lightCount() > 0) {
    m_branches.emplace(*m_tree);
  }
}

/// One random number does for all: its lowest part chooses by intensity, the rest goes down the branches.
LightChoice::Choice LightChoice::chooseByPlace(const LitPoint& point, std::uint32_t bits) const {
  const double u = (static_cast<double>(bits) + 0.5) * 0x1p-32;
  constexpr auto kShare = static_cast<double>(kDefensive);
  if (u < kShare) {
    const auto count = static_cast<std::uint32_t>(m_tree->lightCount());
    const std::uint32_t entry = m_tree->lightAt(m_tree->draw(0, count, u / kShare));
    return {entry, probabilityByPlace(point, entry)};
  }
  const LightBranches::Leaf leaf = m_branches->descend(point, (u - kShare) / (1.0 - kShare));
  if (!(leaf.probability > 0.0F)) {
    return {};
  }
  const std::uint32_t position = m_tree->draw(leaf.begin, leaf.end, leaf.u);
  return {m_tree->lightAt(position), combined(leaf, position)};
}

float LightChoice::probabilityByPlace(const LitPoint& point, std::uint32_t entry) const {
  const std::uint32_t position = m_tree->positionOf(entry);
  return combined(m_branches->leafOf(point, position), position);
}

float LightChoice::combined(const LightBranches::Leaf& leaf, std::uint32_t position) const {
  const double byIntensity = m_tree->share(position, position + 1);
  float within = 1.0F;
  if (leaf.end - leaf.begin > 1) {
    const double all = m_tree->share(leaf.begin, leaf.end);
    within = all > 0.0 ? static_cast<float>(byIntensity / all) : 0.0F;
  }
  return (1.0F - kDefensive) * leaf.probability * within + kDefensive * static_cast<float>(byIntensity);
}

}  // namespace metamer::spectral_ref
