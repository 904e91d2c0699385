// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory_resource>
#include <unordered_map>
#include <vector>

#include "map/map_memory_state.h"
#include "map/map_source.h"
#include "metamer/sip/homogeneous_map.h"

namespace metamer::sip {

/// The transform at a point of a face, as a function of the face's coordinates.
struct FaceNode {
  SpectralTransform::Point point;
  bool hasSlopes = false;
  Eigen::Vector3d alongU;  ///< derivative per unit of the first face coordinate
  Eigen::Vector3d alongV;
  Eigen::Matrix3d metric;  ///< length of metric * error is about CIEDE2000
};

/// The nodes of one part of a map by their places, which count half finest cells. None is dropped before all are.
class FaceNodes {
 public:
  /// @param memory  of the part; may be null
  FaceNodes(const MapSource& source, int face, PartMemory* memory);

  /// The node at a place; one that is new waits for solve().
  FaceNode* at(int u, int v);
  /// Solves the nodes that wait, side by side.
  void solve();
  /// Gives a node that is solved its slopes, once.
  void addSlopes(FaceNode& node) const;

  /// Half finest cells along the face.
  int steps() const { return 1 << (HomogeneousMap::kRootBits[m_faceIndex] + HomogeneousMap::kMaximumDepth + 1); }
  int solveCount() const { return m_solveCount; }

 private:
  int axis() const { return static_cast<int>(m_faceIndex) / 2; }
  int firstAxis() const { return (axis() + 1) % 3; }
  int secondAxis() const { return (axis() + 2) % 3; }

  const MapSource& m_source;
  std::size_t m_faceIndex;
  PartMemory* m_memory;
  std::pmr::monotonic_buffer_resource m_room;
  std::pmr::unordered_map<std::uint64_t, FaceNode> m_nodes{&m_room};
  std::vector<FaceNode*> m_unsolved;
  int m_solveCount = 0;
};

}  // namespace metamer::sip
