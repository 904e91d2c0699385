// SPDX-License-Identifier: Apache-2.0
#include "cube/cube_lattice.h"

#include <Eigen/LU>
#include <algorithm>

#include "operators/parallel.h"

namespace metamer::ocio {
namespace {

Eigen::Vector3f times(const Symmetric& m, const Eigen::Vector3f& v) {
  return {m[0] * v[0] + m[1] * v[1] + m[3] * v[2], m[1] * v[0] + m[2] * v[1] + m[4] * v[2],
          m[3] * v[0] + m[4] * v[1] + m[5] * v[2]};
}

/// The inverse, or zero where there is none.
Symmetric inverted(const Symmetric& m) {
  Eigen::Matrix3d block;
  block << m[0], m[1], m[3], m[1], m[2], m[4], m[3], m[4], m[5];
  const Eigen::Matrix3f found = block.inverse().cast<float>();
  return found.allFinite() ? Symmetric{found(0, 0), found(1, 0), found(1, 1), found(2, 0), found(2, 1), found(2, 2)}
                           : Symmetric{};
}

void accumulate(Symmetric& sum, const Symmetric& m, float factor) {
  for (std::size_t k = 0; k < 6; ++k) {
    sum[k] += factor * m[k];
  }
}

/// Rows a task.
constexpr std::size_t kBlock = 2048;

/// Calls `body(first, last)` for blocks of rows, and sums what it returns in the order of blocks.
template <typename Body>
double sumOverBlocks(std::size_t count, const Body& body) {
  const std::size_t blocks = (count + kBlock - 1) / kBlock;
  std::vector<double> sums(blocks);
  parallelFor(static_cast<int>(blocks), [&](int block) {
    const std::size_t first = kBlock * static_cast<std::size_t>(block);
    sums[static_cast<std::size_t>(block)] = body(first, std::min(count, first + kBlock));
  });
  double sum = 0.0;
  for (const double part : sums) {
    sum += part;
  }
  return sum;
}

}  // namespace

CubeStencil cubeStencil(const Eigen::Vector3f& signal, int size) {
  CubeStencil stencil;
  std::array<float, 3> within{};
  std::array<std::uint8_t, 3> order = {0, 1, 2};
  std::array<std::uint32_t, 3> cell{};
  for (std::size_t k = 0; k < 3; ++k) {
    const float at = std::clamp(signal[static_cast<Eigen::Index>(k)], 0.0F, 1.0F) * static_cast<float>(size - 1);
    cell[k] = std::min(static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(size - 2));
    within[k] = at - static_cast<float>(cell[k]);
  }
  const auto side = static_cast<std::uint32_t>(size);
  stencil.node = cell[0] + side * (cell[1] + side * cell[2]);
  const auto sortPair = [&](std::size_t a, std::size_t b) {
    if (within[order[b]] > within[order[a]]) {
      std::swap(order[a], order[b]);
    }
  };
  sortPair(0, 1);
  sortPair(1, 2);
  sortPair(0, 1);
  unsigned mask = 0;
  float before = 1.0F;
  for (std::size_t k = 0; k < 3; ++k) {
    stencil.weight[k] = before - within[order[k]];
    before = within[order[k]];
    mask |= 1U << order[k];
    stencil.corner[k + 1] = static_cast<std::uint8_t>(mask);
  }
  stencil.weight[3] = before;
  return stencil;
}

CubeEquations::CubeEquations(int size, const std::vector<std::uint8_t>& touched) : m_rowOf(touched.size(), kNone) {
  for (unsigned mask = 0; mask < 8; ++mask) {
    m_steps[mask] = cornerStep(mask, size);
  }
  for (std::uint32_t node = 0; node < touched.size(); ++node) {
    if (touched[node] != 0) {
      m_rowOf[node] = static_cast<std::uint32_t>(m_nodeOf.size());
      m_nodeOf.push_back(node);
    }
  }
  const auto side = static_cast<std::uint32_t>(size);
  std::array<std::uint32_t, 8> none{};
  none.fill(kNone);
  m_above.assign(m_nodeOf.size(), none);
  m_below.assign(m_nodeOf.size(), none);
  for (std::uint32_t row = 0; row < m_nodeOf.size(); ++row) {
    const std::uint32_t node = m_nodeOf[row];
    const std::array<std::uint32_t, 3> at = {node % side, node / side % side, node / (side * side)};
    for (unsigned mask = 0; mask < 8; ++mask) {
      bool isInside = true;
      for (unsigned axis = 0; axis < 3; ++axis) {
        isInside = isInside && at[axis] + ((mask >> axis) & 1U) < side;
      }
      const std::uint32_t other = isInside ? m_rowOf[node + m_steps[mask]] : kNone;
      m_above[row][mask] = other;
      if (other != kNone) {
        m_below[other][mask] = row;
      }
    }
  }
  m_blocks.resize(m_nodeOf.size());
  m_right.resize(m_nodeOf.size());
  clear();
}

void CubeEquations::clear() {
  std::fill(m_blocks.begin(), m_blocks.end(), std::array<Symmetric, 8>{});
  std::fill(m_right.begin(), m_right.end(), Eigen::Vector3f::Zero());
}

void CubeEquations::add(const CubeStencil& stencil, const Symmetric& metric, const Eigen::Vector3f& target,
                        float weight) {
  const Eigen::Vector3f pull = weight * times(metric, target);
  for (std::size_t m = 0; m < 4; ++m) {
    if (!(stencil.weight[m] > 0.0F)) {
      continue;
    }
    const unsigned corner = stencil.corner[m];
    const std::uint32_t row = m_rowOf[stencil.node + m_steps[corner]];
    m_right[row] += stencil.weight[m] * pull;
    for (std::size_t n = m; n < 4; ++n) {
      accumulate(m_blocks[row][stencil.corner[n] ^ corner], metric, weight * stencil.weight[m] * stencil.weight[n]);
    }
  }
}

void CubeEquations::addSmoothness(const Symmetric& stiffness, const Symmetric& attachment,
                                  const std::vector<Eigen::Vector3f>& start) {
  for (std::size_t row = 0; row < m_nodeOf.size(); ++row) {
    const Eigen::Vector3f& here = start[m_nodeOf[row]];
    accumulate(m_blocks[row][0], attachment, 1.0F);
    m_right[row] += times(attachment, here);
    for (const unsigned mask : {1U, 2U, 4U}) {
      const std::uint32_t other = m_above[row][mask];
      if (other != kNone) {
        accumulate(m_blocks[row][0], stiffness, 1.0F);
        accumulate(m_blocks[other][0], stiffness, 1.0F);
        accumulate(m_blocks[row][mask], stiffness, -1.0F);
        const Eigen::Vector3f pull = times(stiffness, start[m_nodeOf[other]] - here);
        m_right[other] += pull;
        m_right[row] -= pull;
      }
    }
  }
}

Symmetric CubeEquations::meanBlock() const {
  std::array<double, 6> sum{};
  for (const auto& row : m_blocks) {
    for (std::size_t k = 0; k < 6; ++k) {
      sum[k] += static_cast<double>(row[0][k]);
    }
  }
  Symmetric mean{};
  for (std::size_t k = 0; k < 6; ++k) {
    mean[k] = static_cast<float>(sum[k] / static_cast<double>(m_blocks.size()));
  }
  return mean;
}

Eigen::Vector3f CubeEquations::rowTimes(std::size_t row, const Column& x) const {
  Eigen::Vector3f sum = times(m_blocks[row][0], x[row]);
  for (unsigned mask = 1; mask < 8; ++mask) {
    const std::uint32_t above = m_above[row][mask];
    if (above != kNone) {
      sum += times(m_blocks[row][mask], x[above]);
    }
    const std::uint32_t below = m_below[row][mask];
    if (below != kNone) {
      sum += times(m_blocks[below][mask], x[below]);
    }
  }
  return sum;
}

int CubeEquations::solve(std::vector<Eigen::Vector3f>& nodes, const std::vector<std::uint8_t>& held, double fall,
                         int most) const {
  const std::size_t count = m_nodeOf.size();
  Column x(count);
  for (std::size_t row = 0; row < count; ++row) {
    x[row] = nodes[m_nodeOf[row]];
  }
  std::vector<Symmetric> inverse(count);  // of the blocks on the diagonal; zero where a node is held
  Column residual(count);
  Column scaled(count);
  double square = sumOverBlocks(count, [&](std::size_t first, std::size_t last) {
    double sum = 0.0;
    for (std::size_t row = first; row < last; ++row) {
      const bool isHeld = held[m_nodeOf[row]] != 0;
      inverse[row] = isHeld ? Symmetric{} : inverted(m_blocks[row][0]);
      residual[row] = isHeld ? Eigen::Vector3f::Zero() : Eigen::Vector3f(m_right[row] - rowTimes(row, x));
      scaled[row] = times(inverse[row], residual[row]);
      sum += static_cast<double>(residual[row].dot(scaled[row]));
    }
    return sum;
  });
  const double enough = square * fall * fall;
  Column direction = scaled;
  Column product(count);
  int step = 0;
  for (; step < most && square > enough; ++step) {
    const double curvature = sumOverBlocks(count, [&](std::size_t first, std::size_t last) {
      double sum = 0.0;
      for (std::size_t row = first; row < last; ++row) {
        product[row] = held[m_nodeOf[row]] != 0 ? Eigen::Vector3f::Zero() : rowTimes(row, direction);
        sum += static_cast<double>(direction[row].dot(product[row]));
      }
      return sum;
    });
    if (!(curvature > 0.0)) {
      break;
    }
    const auto stride = static_cast<float>(square / curvature);
    const double next = sumOverBlocks(count, [&](std::size_t first, std::size_t last) {
      double sum = 0.0;
      for (std::size_t row = first; row < last; ++row) {
        x[row] += stride * direction[row];
        residual[row] -= stride * product[row];
        scaled[row] = times(inverse[row], residual[row]);
        sum += static_cast<double>(residual[row].dot(scaled[row]));
      }
      return sum;
    });
    const auto turn = static_cast<float>(next / square);
    square = next;
    for (std::size_t row = 0; row < count; ++row) {
      direction[row] = scaled[row] + turn * direction[row];
    }
  }
  for (std::size_t row = 0; row < count; ++row) {
    nodes[m_nodeOf[row]] = x[row];
  }
  return step;
}

}  // namespace metamer::ocio
