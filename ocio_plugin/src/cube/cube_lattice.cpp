// SPDX-License-Identifier: Apache-2.0
#include "cube/cube_lattice.h"

#include <Eigen/LU>
#include <algorithm>

#include "operators/parallel.h"

namespace metamer::ocio {
namespace {

Padded padded(const Eigen::Vector3f& v) {
  return {v[0], v[1], v[2], 0.0F};
}

Padded times(const Symmetric& m, const Padded& v) {
  return m.col(0) * v[0] + m.col(1) * v[1] + m.col(2) * v[2];
}

double product(const Padded& a, const Padded& b) {
  return static_cast<double>(a.head<3>().dot(b.head<3>()));
}

/// The inverse, or zero where there is none.
Symmetric inverted(const Symmetric& m) {
  const Eigen::Matrix3d block = m.topRows<3>().cast<double>();
  Symmetric inverse = Symmetric::Zero();
  inverse.topRows<3>() = block.inverse().cast<float>();
  return inverse.allFinite() ? inverse : Symmetric::Zero();
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
  for (auto& row : m_blocks) {
    row.fill(Symmetric::Zero());
  }
  std::fill(m_right.begin(), m_right.end(), Padded::Zero());
}

void CubeEquations::add(const CubeStencil& stencil, const Symmetric& metric, const Eigen::Vector3f& target,
                        float weight) {
  const Padded pull = weight * times(metric, padded(target));
  for (std::size_t m = 0; m < 4; ++m) {
    if (!(stencil.weight[m] > 0.0F)) {
      continue;
    }
    const unsigned corner = stencil.corner[m];
    const std::uint32_t row = m_rowOf[stencil.node + m_steps[corner]];
    m_right[row] += stencil.weight[m] * pull;
    for (std::size_t n = m; n < 4; ++n) {
      m_blocks[row][stencil.corner[n] ^ corner] += weight * stencil.weight[m] * stencil.weight[n] * metric;
    }
  }
}

void CubeEquations::addSmoothness(const Symmetric& stiffness, const Symmetric& attachment,
                                  const std::vector<Eigen::Vector3f>& start) {
  for (std::size_t row = 0; row < m_nodeOf.size(); ++row) {
    const Padded here = padded(start[m_nodeOf[row]]);
    m_blocks[row][0] += attachment;
    m_right[row] += times(attachment, here);
    for (const unsigned mask : {1U, 2U, 4U}) {
      const std::uint32_t other = m_above[row][mask];
      if (other != kNone) {
        m_blocks[row][0] += stiffness;
        m_blocks[other][0] += stiffness;
        m_blocks[row][mask] -= stiffness;
        const Padded pull = times(stiffness, padded(start[m_nodeOf[other]]) - here);
        m_right[other] += pull;
        m_right[row] -= pull;
      }
    }
  }
}

Symmetric CubeEquations::meanBlock() const {
  Eigen::Matrix<double, 4, 3> sum = Eigen::Matrix<double, 4, 3>::Zero();
  for (const auto& row : m_blocks) {
    sum += row[0].cast<double>();
  }
  return (sum / static_cast<double>(m_blocks.size())).cast<float>();
}

Padded CubeEquations::rowTimes(std::size_t row, const Column& x) const {
  Padded sum = times(m_blocks[row][0], x[row]);
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
    x[row] = padded(nodes[m_nodeOf[row]]);
  }
  std::vector<Symmetric> inverse(count);  // of the blocks on the diagonal; zero where a node is held
  Column residual(count);
  Column scaled(count);
  double square = sumOverBlocks(count, [&](std::size_t first, std::size_t last) {
    double sum = 0.0;
    for (std::size_t row = first; row < last; ++row) {
      const bool isHeld = held[m_nodeOf[row]] != 0;
      inverse[row] = isHeld ? Symmetric(Symmetric::Zero()) : inverted(m_blocks[row][0]);
      residual[row] = isHeld ? Padded(Padded::Zero()) : Padded(m_right[row] - rowTimes(row, x));
      scaled[row] = times(inverse[row], residual[row]);
      sum += product(residual[row], scaled[row]);
    }
    return sum;
  });
  const double enough = square * fall * fall;
  Column direction = scaled;
  Column image(count);
  int step = 0;
  for (; step < most && square > enough; ++step) {
    const double curvature = sumOverBlocks(count, [&](std::size_t first, std::size_t last) {
      double sum = 0.0;
      for (std::size_t row = first; row < last; ++row) {
        image[row] = held[m_nodeOf[row]] != 0 ? Padded(Padded::Zero()) : rowTimes(row, direction);
        sum += product(direction[row], image[row]);
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
        residual[row] -= stride * image[row];
        scaled[row] = times(inverse[row], residual[row]);
        sum += product(residual[row], scaled[row]);
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
    nodes[m_nodeOf[row]] = x[row].head<3>();
  }
  return step;
}

}  // namespace metamer::ocio
