// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "soft_bound/soft_bound_solver.h"

namespace metamer::sip {

/// Evenly spaced nodes and bands over the same wavelengths, both piecewise linear: what one makes of the other.
class NodeBands {
 public:
  NodeBands(Eigen::Index nodeCount, Eigen::Index bandCount);

  /// Weights of the nodes from those of the bands.
  Eigen::Matrix3Xd nodeWeights(const Eigen::Matrix3Xd& bandWeights) const;
  /// What is known at the bands, read at the nodes.
  Eigen::MatrixX3d atNodes(const BandTriple& bands) const;
  /// What is known at the nodes, read at the bands.
  template <typename Nodes>
  auto atBands(const Nodes& nodes) const {
    Eigen::Matrix<double, Eigen::Dynamic, Nodes::ColsAtCompileTime, 0, kConvergedBandCount, Nodes::ColsAtCompileTime>
        bands(m_nodes.size(), nodes.cols());
    for (Eigen::Index b = 0; b < m_nodes.size(); ++b) {
      bands.row(b) = (1.0 - m_fractions[b]) * nodes.row(m_nodes[b]) + m_fractions[b] * nodes.row(m_nodes[b] + 1);
    }
    return bands;
  }

  Eigen::Index bandCount() const { return m_nodes.size(); }

 private:
  Eigen::Index m_nodeCount;
  Eigen::VectorXi m_nodes;      ///< a band lies between this node and the next,
  Eigen::VectorXd m_fractions;  ///< so far from the first
};

}  // namespace metamer::sip
