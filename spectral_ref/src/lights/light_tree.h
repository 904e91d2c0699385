// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/geometry.h"

namespace metamer::spectral_ref {

/// A point that is to be lit.
struct LitPoint {
  Vec3 place = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();
  bool isTwoSided = false;  ///< whether light from behind counts as well
};

/// Where a light lies and where it shines: enough to bound what it gives a receiver.
struct LightBounds {
  Vec3 least = Vec3::Zero();  ///< box around it; infinitely far: around the unit vectors towards it
  Vec3 most = Vec3::Zero();
  Vec3 axis = Vec3::UnitZ();  ///< of a cone of normals; infinitely far: of the directions towards it
  float spread = 0;           ///< half angle of that cone, radians; pi: it shines all around
  float intensity = 0;        ///< irradiance on a receiver that faces it at distance 1 (infinitely far: at any)
  bool isInfinite = false;
};

/// A hierarchy of lights, by which a receiver tells those that matter to it from the others without looking at each
/// (Conty Estevez and Kulla 2018, Importance Sampling of Many Lights with Adaptive Tree Splitting).
///
/// Lights are put in an order in which every node is a range; a light within a range is drawn in proportion to its
/// intensity.
class LightTree {
 public:
  struct Node {
    Vec3 center;   ///< of a ball around all lights of the node
    float radius;  ///< of that ball
    Vec3 axis;
    float cosSpread;
    float sinSpread;
    float intensity;      ///< sum of its lights'
    std::uint32_t begin;  ///< its range in the order
    std::uint32_t end;
    std::uint32_t right;  ///< second child; the first is the next node. 0: a leaf, one light
    bool isInfinite;
  };

  /// @param lights  by number; those of no intensity are never drawn
  explicit LightTree(const std::vector<LightBounds>& lights);

  const Node& node(std::uint32_t index) const { return m_nodes[index]; }
  std::size_t lightCount() const { return m_order.size(); }
  std::uint32_t lightAt(std::uint32_t position) const { return m_order[position]; }
  std::uint32_t positionOf(std::uint32_t light) const { return m_position[light]; }

  /// About the irradiance that a node may give: never less than its lights would from the centre of its ball.
  static float importance(const Node& node, const Vec3& place, const Vec3& normal);

  /// Draws a position in begin ... end - 1 in proportion to intensity. @param u  0 ... 1
  std::uint32_t draw(std::uint32_t begin, std::uint32_t end, double u) const;
  /// Intensity of a range over that of all lights.
  double share(std::uint32_t begin, std::uint32_t end) const {
    return (m_below[end] - m_below[begin]) / m_below.back();
  }

 private:
  std::vector<Node> m_nodes;
  std::vector<std::uint32_t> m_order;     ///< light at each position
  std::vector<std::uint32_t> m_position;  ///< of each light
  std::vector<double> m_below;            ///< intensity of all positions before; one more than lights
};

}  // namespace metamer::spectral_ref
