// SPDX-License-Identifier: Apache-2.0
#include "chain/lattice_fit.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <optional>

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

/// Normal equations of least squares over a lattice's unknowns, as 3 x 3 blocks.
class NormalEquations {
 public:
  NormalEquations(const std::vector<Eigen::Vector3d>& nodes, const std::vector<int>& unknowns)
      : m_nodes(nodes), m_unknowns(unknowns) {
    const int count = unknowns.empty() ? 0 : 1 + *std::max_element(unknowns.begin(), unknowns.end());
    m_right = Eigen::VectorXd::Zero(3 * std::max(0, count));
  }

  /// Adds metric-weighted squares of `sum_m coefficient[m] node[m] - value`.
  template <std::size_t N>
  void add(const std::array<std::size_t, N>& node, const std::array<double, N>& coefficient,
           const Eigen::Matrix3d& metric, Eigen::Vector3d value) {
    for (std::size_t m = 0; m < N; ++m) {
      if (m_unknowns[node[m]] < 0) {
        value -= coefficient[m] * m_nodes[node[m]];
      }
    }
    const Eigen::Vector3d pull = metric * value;
    for (std::size_t m = 0; m < N; ++m) {
      const int row = m_unknowns[node[m]];
      if (row < 0) {
        continue;
      }
      m_right.segment<3>(3 * row) += coefficient[m] * pull;
      for (std::size_t n = 0; n < N; ++n) {
        if (m_unknowns[node[n]] >= 0) {
          put(row, m_unknowns[node[n]], coefficient[m] * coefficient[n] * metric);
        }
      }
    }
  }

  /// The unknowns; nothing where the equations have no stable solution.
  std::optional<Eigen::VectorXd> solve() const {
    Eigen::SparseMatrix<double> matrix(m_right.size(), m_right.size());
    matrix.setFromTriplets(m_entries.begin(), m_entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(matrix);
    Eigen::VectorXd solution = factors.solve(m_right);
    if (factors.info() != Eigen::Success || !solution.allFinite()) {
      return std::nullopt;
    }
    return solution;
  }

 private:
  /// The lower half, which is all that is factorised.
  void put(int row, int column, const Eigen::Matrix3d& block) {
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        if (3 * row + r >= 3 * column + c) {
          m_entries.emplace_back(3 * row + r, 3 * column + c, block(r, c));
        }
      }
    }
  }

  const std::vector<Eigen::Vector3d>& m_nodes;
  const std::vector<int>& m_unknowns;
  std::vector<Eigen::Triplet<double>> m_entries;
  Eigen::VectorXd m_right;
};

}  // namespace

void fitLattice(PlaneLattice& lattice, const std::vector<LatticeSample>& samples, const std::vector<int>& unknowns) {
  if (samples.empty()) {
    return;
  }
  Eigen::Matrix3d meanMetric = Eigen::Matrix3d::Zero();
  for (const auto& sample : samples) {
    meanMetric += sample.metric / static_cast<double>(samples.size());
  }
  const Eigen::Matrix3d stiffness = kStiffness * (meanMetric + 1e-3 * meanMetric.trace() * Eigen::Matrix3d::Identity());

  NormalEquations equations(lattice.nodes, unknowns);
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
  if (const auto solution = equations.solve()) {
    for (std::size_t node = 0; node < unknowns.size(); ++node) {
      if (unknowns[node] >= 0) {
        lattice.nodes[node] = solution->segment<3>(3 * unknowns[node]);
      }
    }
  }
}

}  // namespace metamer::ocio
