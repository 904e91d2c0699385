// SPDX-License-Identifier: Apache-2.0
#include "chain/lattice_fit.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>

namespace metamer::ocio {
namespace {

/// Weight of keeping to the shape of the starting values, against the mean sample: small enough to cost no accuracy,
/// large enough to carry the solution to nodes that no sample touches.
constexpr double kStiffness = 1e-5;

}  // namespace

PlaneLattice::Stencil PlaneLattice::stencil(const Eigen::Vector2d& point) const {
  std::array<int, 2> cell{};
  std::array<double, 2> within{};
  for (int k = 0; k < 2; ++k) {
    const auto& along = ticks[k];
    const double x = std::clamp(point[k], 0.0, 1.0);
    const auto above = std::upper_bound(along.begin() + 1, along.end() - 1, x) - along.begin();
    cell[k] = static_cast<int>(above) - 1;
    within[k] = (x - along[cell[k]]) / (along[above] - along[cell[k]]);
  }
  const auto [i, j] = cell;
  const auto [u, v] = within;
  if (u >= v) {
    return {{index(i, j), index(i + 1, j), index(i + 1, j + 1)}, {1.0 - u, u - v, v}};
  }
  return {{index(i, j), index(i, j + 1), index(i + 1, j + 1)}, {1.0 - v, v - u, u}};
}

Eigen::Vector3d PlaneLattice::at(const Eigen::Vector2d& point) const {
  const Stencil s = stencil(point);
  return s.weight[0] * nodes[s.node[0]] + s.weight[1] * nodes[s.node[1]] + s.weight[2] * nodes[s.node[2]];
}

namespace {

/// Normal equations of a lattice as 3 x 3 blocks: each node with itself and with its neighbours at (1, 0), (0, 1) and
/// (1, 1), which are all that a triangle couples.
class NormalEquations {
 public:
  explicit NormalEquations(const PlaneLattice& lattice)
      : m_size(lattice.size()),
        m_blocks(4 * lattice.nodes.size(), Eigen::Matrix3d::Zero()),
        m_right(lattice.nodes.size(), Eigen::Vector3d::Zero()) {}

  /// Adds metric-weighted squares of `sum_m coefficient[m] node[m] - value`.
  template <std::size_t N>
  void add(const std::array<std::size_t, N>& node, const std::array<double, N>& coefficient,
           const Eigen::Matrix3d& metric, const Eigen::Vector3d& value) {
    const Eigen::Vector3d pull = metric * value;
    for (std::size_t m = 0; m < N; ++m) {
      m_right[node[m]] += coefficient[m] * pull;
      for (std::size_t n = 0; n < N; ++n) {
        if (node[n] >= node[m]) {
          m_blocks[4 * node[m] + slot(node[n] - node[m])] += coefficient[m] * coefficient[n] * metric;
        }
      }
    }
  }

  /// Solves with one node held at its value in `nodes`, and writes the others there.
  /// Leaves the nodes as they are where the equations have no stable solution.
  void solve(std::vector<Eigen::Vector3d>& nodes, std::size_t held) {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(9 * m_blocks.size());
    Eigen::VectorXd right(static_cast<Eigen::Index>(3 * nodes.size()));
    const auto put = [&](std::size_t row, std::size_t column, const Eigen::Matrix3d& block) {
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
          if (row != column || r >= c) {
            entries.emplace_back(static_cast<int>(3 * row) + r, static_cast<int>(3 * column) + c, block(r, c));
          }
        }
      }
    };
    const std::array<std::size_t, 4> steps = {0, static_cast<std::size_t>(m_size), 1,
                                              static_cast<std::size_t>(m_size) + 1};
    for (std::size_t node = 0; node < nodes.size(); ++node) {
      for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t other = node + steps[k];
        const Eigen::Matrix3d& block = m_blocks[4 * node + k];
        if (other >= nodes.size() || (k > 0 && block.isZero(0.0))) {
          continue;
        }
        if (node == held || other == held) {
          if (k == 0) {
            put(held, held, Eigen::Matrix3d::Identity());
          } else {
            m_right[node == held ? other : node] -= block * nodes[held];
          }
        } else {
          put(other, node, block);
        }
      }
    }
    m_right[held] = nodes[held];
    for (std::size_t node = 0; node < nodes.size(); ++node) {
      right.segment<3>(static_cast<Eigen::Index>(3 * node)) = m_right[node];
    }
    Eigen::SparseMatrix<double> matrix(right.size(), right.size());
    matrix.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(matrix);
    const Eigen::VectorXd solution = factors.solve(right);
    if (factors.info() != Eigen::Success || !solution.allFinite()) {
      return;
    }
    for (std::size_t node = 0; node < nodes.size(); ++node) {
      nodes[node] = solution.segment<3>(static_cast<Eigen::Index>(3 * node));
    }
  }

 private:
  std::size_t slot(std::size_t step) const {
    return step == 0 ? 0 : step == static_cast<std::size_t>(m_size) ? 1 : step == 1 ? 2 : 3;
  }

  int m_size;
  std::vector<Eigen::Matrix3d> m_blocks;
  std::vector<Eigen::Vector3d> m_right;
};

}  // namespace

void fitLattice(PlaneLattice& lattice, const std::vector<LatticeSample>& samples, std::size_t held) {
  if (samples.empty()) {
    return;
  }
  Eigen::Matrix3d meanMetric = Eigen::Matrix3d::Zero();
  for (const auto& sample : samples) {
    meanMetric += sample.metric / static_cast<double>(samples.size());
  }
  const Eigen::Matrix3d stiffness = kStiffness * (meanMetric + 1e-3 * meanMetric.trace() * Eigen::Matrix3d::Identity());

  NormalEquations equations(lattice);
  for (const auto& sample : samples) {
    const auto stencil = lattice.stencil(sample.point);
    equations.add(stencil.node, stencil.weight, sample.metric, sample.value);
  }
  for (int i = 0; i < lattice.size(); ++i) {
    for (int j = 0; j < lattice.size(); ++j) {
      const std::size_t node = lattice.index(i, j);
      for (const std::size_t next : {lattice.index(i + 1, j), lattice.index(i, j + 1)}) {
        if (next < lattice.nodes.size() && (next != node + 1 || j + 1 < lattice.size())) {
          equations.add(std::array{node, next}, std::array{-1.0, 1.0}, stiffness,
                        lattice.nodes[next] - lattice.nodes[node]);
        }
      }
    }
  }
  equations.solve(lattice.nodes, held);
}

}  // namespace metamer::ocio
