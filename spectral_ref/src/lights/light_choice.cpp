// SPDX-License-Identifier: Apache-2.0
#include "lights/light_choice.h"

#include <array>

namespace metamer::spectral_ref {

LightChoice::LightChoice(const LightTable& lights, const LightTree* tree) : m_lights(lights), m_tree(tree) {
  if (m_tree != nullptr && m_tree->lightCount() > 0) {
    m_branches.emplace(*m_tree);
  }
}

/// One random number does for all: its lowest part chooses by intensity, the rest goes down the branches.
void LightChoice::chooseByPlace(std::span<const LitPoint> points, std::span<const std::uint32_t> bits,
                                std::span<Choice> choices) const {
  constexpr auto kShare = static_cast<double>(kDefensive);
  std::array<LitPoint, kMostTogether> descending;
  std::array<LightBranches::Leaf, kMostTogether> leaves;
  std::array<std::size_t, kMostTogether> numbers{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double u = (static_cast<double>(bits[i]) + 0.5) * 0x1p-32;
    if (u < kShare) {
      const auto lights = static_cast<std::uint32_t>(m_tree->lightCount());
      const std::uint32_t entry = m_tree->lightAt(m_tree->draw(0, lights, u / kShare));
      choices[i] = {entry, probabilityByPlace(points[i], entry)};
    } else {
      descending[count] = points[i];
      leaves[count].u = (u - kShare) / (1.0 - kShare);
      numbers[count++] = i;
    }
  }
  m_branches->descend({descending.data(), count}, {leaves.data(), count});
  for (std::size_t n = 0; n < count; ++n) {
    const LightBranches::Leaf& leaf = leaves[n];
    Choice& choice = choices[numbers[n]];
    choice = {};
    if (leaf.probability > 0.0F) {
      const std::uint32_t position = m_tree->draw(leaf.begin, leaf.end, leaf.u);
      choice = {m_tree->lightAt(position), combined(leaf, position)};
    }
  }
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
