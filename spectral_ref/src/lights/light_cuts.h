// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lights/light_tree.h"

namespace metamer::spectral_ref {

/// For each block of pixels, how likely each light is to be a candidate of resampling there: a cut through the light
/// tree, deeper where more light comes from (Walter et al. 2005, Lightcuts), by what lights give to points that the
/// block sees.
///
/// The cut is made once; drawing takes a search among its clusters and one among a cluster's lights. One random number
/// does for both, so that stratified numbers stay so: neighbours in the tree are neighbours in space.
class LightCuts {
 public:
  static constexpr std::size_t kReceivers = 4;
  static constexpr std::size_t kClusters = 64;
  /// Memory that a block takes.
  static constexpr std::size_t kBytesABlock = kClusters * 8;

  LightCuts(const LightTree& tree, std::size_t blocks);

  /// Makes the cut of a block. Not two threads at one block.
  /// @param receivers  at most kReceivers; none: lights by intensity
  void build(std::size_t block, const std::vector<LitPoint>& receivers);

  struct Choice {
    std::uint32_t light;
    float probability;
  };
  Choice choose(std::size_t block, std::uint32_t bits) const;
  float probability(std::size_t block, std::uint32_t light) const;
  /// Whether a single light takes up so much of a receiver's view that points on it differ much.
  bool isNear(std::size_t block) const { return m_headers[block].isNear; }

 private:
  /// Share of the candidates that is drawn by intensity alone, so that no light is left out.
  static constexpr double kDefensive = 0.1;
  /// Of a light's half size to its distance; of the sine of half its angle where it is infinitely far.
  static constexpr float kNear = 0.5F;

  struct Cluster {
    std::uint32_t end;    ///< positions in the tree's order before it are this cluster's or an earlier one's
    std::uint32_t below;  ///< chances of 2^32 of this and all earlier clusters; the last one has all that are left
  };
  static_assert(kBytesABlock == kClusters * sizeof(Cluster));
  struct Header {
    std::uint8_t count = 0;
    bool isNear = false;
  };
  /// A cluster's positions and chances. Probabilities are worked out from what is stored, rounded as it is.
  struct Span {
    std::uint32_t begin;
    std::uint32_t end;
    std::uint32_t below;
    double chances;
  };
  /// Whether a light takes up much of the view from a place.
  static bool isWide(const LightTree::Node& node, const Vec3& place);
  Span spanOf(std::size_t block, std::size_t index) const;
  Choice choiceIn(const Span& span, std::uint32_t position) const;

  const LightTree& m_tree;
  std::vector<Header> m_headers;
  std::vector<Cluster> m_clusters;  ///< kClusters a block
};

}  // namespace metamer::spectral_ref
