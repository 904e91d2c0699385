// SPDX-License-Identifier: Apache-2.0
#include "scenes/node_bands.h"

#include <algorithm>

namespace metamer::sip {

using Eigen::Index;

NodeBands::NodeBands(Index nodeCount, Index bandCount)
    : m_nodeCount(nodeCount), m_nodes(bandCount), m_fractions(bandCount) {
  for (Index b = 0; b < bandCount; ++b) {
    const double position = static_cast<double>((nodeCount - 1) * b) / static_cast<double>(bandCount - 1);
    m_nodes[b] = std::min(static_cast<int>(position), static_cast<int>(nodeCount) - 2);
    m_fractions[b] = position - m_nodes[b];
  }
}

Eigen::Matrix3Xd NodeBands::nodeWeights(const Eigen::Matrix3Xd& bandWeights) const {
  Eigen::Matrix3Xd weights = Eigen::Matrix3Xd::Zero(3, m_nodeCount);
  for (Index b = 0; b < bandCount(); ++b) {
    weights.col(m_nodes[b]) += (1.0 - m_fractions[b]) * bandWeights.col(b);
    weights.col(m_nodes[b] + 1) += m_fractions[b] * bandWeights.col(b);
  }
  return weights;
}

Eigen::MatrixX3d NodeBands::atNodes(const BandTriple& bands) const {
  Eigen::MatrixX3d nodes(m_nodeCount, 3);
  for (Index j = 0; j < m_nodeCount; ++j) {
    const double position = static_cast<double>((bandCount() - 1) * j) / static_cast<double>(m_nodeCount - 1);
    const Index band = std::min(static_cast<Index>(position), bandCount() - 2);
    const double fraction = position - static_cast<double>(band);
    nodes.row(j) = (1.0 - fraction) * bands.row(band) + fraction * bands.row(band + 1);
  }
  return nodes;
}

}  // namespace metamer::sip
