// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "lights/light_branches.h"
#include "lights/light_table.h"
#include "lights/light_tree.h"

namespace metamer::spectral_ref {

/// Which light next-event estimation asks at a point: by what lights may give there (distance, both angles), or by
/// their power.
class LightChoice {
 public:
  /// @param tree  of the table's lights; null: by power
  LightChoice(const LightTable& lights, const LightTree* tree);

  /// Whether a choice by place is worth its steps: a few lights are soon told apart by chance.
  static bool isWorthwhile(const LightTable& lights) { return lights.nearCount() >= kFewest; }

  struct Choice {
    std::uint32_t entry = 0;
    float probability = 0;  ///< 0: no light reaches the point
  };
  Choice choose(const LitPoint& point, std::uint32_t bits) const {
    Choice choice;
    choose({&point, 1}, {&bits, 1}, {&choice, 1});
    return choice;
  }
  /// For several points, in less time. @param choices  of each; at most kMostTogether
  void choose(std::span<const LitPoint> points, std::span<const std::uint32_t> bits, std::span<Choice> choices) const {
    if (m_branches) {
      chooseByPlace(points, bits, choices);
      return;
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::uint32_t entry = m_lights.choose(bits[i], 0.0F, 0.0F).entry;
      choices[i] = {entry, m_lights.probability(entry)};
    }
  }
  static constexpr std::size_t kMostTogether = LightBranches::kMostTogether;
  /// Of choosing an entry.
  float probability(const LitPoint& point, std::uint32_t entry) const {
    return m_branches ? probabilityByPlace(point, entry) : m_lights.probability(entry);
  }

 private:
  static constexpr std::size_t kFewest = 4;
  /// Share that is drawn by intensity alone: what a node may give says nothing of what hides it.
  static constexpr float kDefensive = 0.1F;

  void chooseByPlace(std::span<const LitPoint> points, std::span<const std::uint32_t> bits,
                     std::span<Choice> choices) const;
  float probabilityByPlace(const LitPoint& point, std::uint32_t entry) const;
  float combined(const LightBranches::Leaf& leaf, std::uint32_t position) const;

  const LightTable& m_lights;
  const LightTree* m_tree;
  std::optional<LightBranches> m_branches;
};

}  // namespace metamer::spectral_ref
