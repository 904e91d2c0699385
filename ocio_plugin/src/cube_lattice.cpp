// SPDX-License-Identifier: Apache-2.0
#include "cube_lattice.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace metamer::ocio {
namespace {

Eigen::Vector3f times(const Symmetric& m, const Eigen::Vector3f& v) {
  return {m[0] * v[0] + m[1] * v[1] + m[3] * v[2], m[1] * v[0] + m[2] * v[1] + m[4] * v[2],
          m[3] * v[0] + m[4] * v[1] + m[5] * v[2]};
}

void accumulate(Symmetric& sum, const Symmetric& m, float factor) {
  for (std::size_t k = 0; k < 6; ++k) {
    sum[k] += factor * m[k];
  }
}

double dot(const std::vector<Eigen::Vector3f>& a, const std::vector<Eigen::Vector3f>& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    sum += static_cast<double>(a[k].dot(b[k]));
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

CubeEquations::CubeEquations(int size) {
  const auto count = static_cast<std::size_t>(size) * static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
  m_blocks.resize(count);
  m_right.resize(count);
  for (unsigned mask = 0; mask < 8; ++mask) {
    m_steps[mask] = cornerStep(mask, size);
  }
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
    const unsigned corner = stencil.corner[m];
    const std::uint32_t node = stencil.node + m_steps[corner];
    m_right[node] += stencil.weight[m] * pull;
    for (std::size_t n = m; n < 4; ++n) {
      accumulate(m_blocks[node][stencil.corner[n] ^ corner], metric, weight * stencil.weight[m] * stencil.weight[n]);
    }
  }
}

void CubeEquations::addDifference(std::uint32_t node, unsigned mask, const Symmetric& metric,
                                  const Eigen::Vector3f& target) {
  const std::uint32_t other = node + m_steps[mask];
  accumulate(m_blocks[node][0], metric, 1.0F);
  accumulate(m_blocks[other][0], metric, 1.0F);
  accumulate(m_blocks[node][mask], metric, -1.0F);
  const Eigen::Vector3f pull = times(metric, target);
  m_right[other] += pull;
  m_right[node] -= pull;
}

void CubeEquations::addValue(std::uint32_t node, const Symmetric& metric, const Eigen::Vector3f& target) {
  accumulate(m_blocks[node][0], metric, 1.0F);
  m_right[node] += times(metric, target);
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

void CubeEquations::multiply(const std::vector<Eigen::Vector3f>& x, std::vector<Eigen::Vector3f>& result) const {
  std::fill(result.begin(), result.end(), Eigen::Vector3f::Zero());
  const std::size_t count = x.size();
  for (std::size_t node = 0; node < count; ++node) {
    const auto& row = m_blocks[node];
    Eigen::Vector3f sum = times(row[0], x[node]);
    for (unsigned mask = 1; mask < 8; ++mask) {
      const std::size_t other = node + m_steps[mask];
      if (other < count) {
        sum += times(row[mask], x[other]);
        result[other] += times(row[mask], x[node]);
      }
    }
    result[node] += sum;
  }
}

int CubeEquations::solve(std::vector<Eigen::Vector3f>& nodes, const std::vector<std::uint8_t>& held, double fall,
                         int most) const {
  const std::size_t count = nodes.size();
  std::vector<Eigen::Matrix3f> inverse(count);
  for (std::size_t node = 0; node < count; ++node) {
    const Symmetric& m = m_blocks[node][0];
    Eigen::Matrix3d block;
    block << m[0], m[1], m[3], m[1], m[2], m[4], m[3], m[4], m[5];
    const Eigen::Matrix3d found = block.inverse();
    inverse[node] =
        held[node] == 0 && found.allFinite() ? Eigen::Matrix3f(found.cast<float>()) : Eigen::Matrix3f::Zero();
  }
  std::vector<Eigen::Vector3f> residual(count);
  std::vector<Eigen::Vector3f> product(count);
  multiply(nodes, product);
  const auto precondition = [&](std::vector<Eigen::Vector3f>& result) {
    for (std::size_t k = 0; k < count; ++k) {
      result[k] = inverse[k] * residual[k];
    }
  };
  for (std::size_t k = 0; k < count; ++k) {
    residual[k] = held[k] != 0 ? Eigen::Vector3f::Zero() : Eigen::Vector3f(m_right[k] - product[k]);
  }
  std::vector<Eigen::Vector3f> scaled(count);
  precondition(scaled);
  std::vector<Eigen::Vector3f> direction = scaled;
  double square = dot(residual, scaled);
  const double enough = square * fall * fall;
  int step = 0;
  for (; step < most && square > enough; ++step) {
    multiply(direction, product);
    for (std::size_t k = 0; k < count; ++k) {
      if (held[k] != 0) {
        product[k].setZero();
      }
    }
    const double curvature = dot(direction, product);
    if (!(curvature > 0.0)) {
      break;
    }
    const auto stride = static_cast<float>(square / curvature);
    for (std::size_t k = 0; k < count; ++k) {
      nodes[k] += stride * direction[k];
      residual[k] -= stride * product[k];
    }
    precondition(scaled);
    const double next = dot(residual, scaled);
    const auto turn = static_cast<float>(next / square);
    square = next;
    for (std::size_t k = 0; k < count; ++k) {
      direction[k] = scaled[k] + turn * direction[k];
    }
  }
  return step;
}

}  // namespace metamer::ocio
