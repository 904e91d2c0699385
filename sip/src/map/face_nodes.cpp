// SPDX-License-Identifier: Apache-2.0
#include "map/face_nodes.h"

namespace metamer::sip {

FaceNodes::FaceNodes(const MapSource& source, int face, PartMemory* memory)
    : m_source(source), m_faceIndex(static_cast<std::size_t>(face)), m_memory(memory) {
  if (memory != nullptr) {
    memory->beginBuild();
  }
}

FaceNode* FaceNodes::at(int u, int v) {
  const std::uint64_t key = (static_cast<std::uint64_t>(u) << 20) | static_cast<std::uint64_t>(v);
  const auto [place, isNew] = m_nodes.try_emplace(key);
  FaceNode& node = place->second;
  if (isNew) {
    Eigen::Vector3d cube;
    cube[axis()] = m_faceIndex % 2 == 0 ? 1.0 : -1.0;
    cube[firstAxis()] = 2.0 * u / steps() - 1.0;
    cube[secondAxis()] = 2.0 * v / steps() - 1.0;
    node.point.rgb = m_source.rgbFromCube * cube;
    if (m_memory != nullptr) {
      node.point.kept = m_memory->at(key);
    }
    m_unsolved.push_back(&node);
  }
  return &node;
}

void FaceNodes::solve() {
  std::vector<SpectralTransform::Point> points;
  points.reserve(m_unsolved.size());
  for (const FaceNode* node : m_unsolved) {
    points.push_back(node->point);
  }
  m_source.transform.solve(points);
  for (std::size_t k = 0; k < points.size(); ++k) {
    FaceNode& node = *m_unsolved[k];
    node.point = points[k];
    node.metric = m_source.metric.at(node.point.rgb, node.point.value);
  }
  m_solveCount += static_cast<int>(points.size());
  m_unsolved.clear();
}

void FaceNodes::addSlopes(FaceNode& node) const {
  if (!node.hasSlopes) {
    const Eigen::Matrix3d slope = m_source.transform.slopeAt(node.point);
    node.alongU = slope * m_source.rgbFromCube.col(firstAxis());
    node.alongV = slope * m_source.rgbFromCube.col(secondAxis());
    node.hasSlopes = true;
  }
}

}  // namespace metamer::sip
