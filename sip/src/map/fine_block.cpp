// SPDX-License-Identifier: Apache-2.0
#include "map/fine_block.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace metamer::sip {

namespace {

constexpr std::size_t squared(int side) {
  return static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
}

/// Of a node in the whole table, in floats.
constexpr std::size_t placeOf(int column, int row) {
  constexpr std::size_t kNodesPerRow = std::size_t{HomogeneousMap::kFineSide} + 1;
  return 4 * (static_cast<std::size_t>(row) * kNodesPerRow + static_cast<std::size_t>(column));
}

}  // namespace

FineBlock::FineBlock(int firstColumn, int firstRow, int side)
    : m_firstColumn(firstColumn),
      m_firstRow(firstRow),
      m_side(side),
      m_nodes(3 * squared(side + 1), std::numeric_limits<float>::quiet_NaN()),
      m_isGood(squared(side)) {}

Eigen::Map<Eigen::Vector3f> FineBlock::node(int column, int row) {
  const auto index = static_cast<std::size_t>((row - m_firstRow) * (m_side + 1) + column - m_firstColumn);
  return Eigen::Map<Eigen::Vector3f>(m_nodes.data() + 3 * index);
}

std::size_t FineBlock::cellIndex(int column, int row) const {
  return static_cast<std::size_t>((row - m_firstRow) * m_side + column - m_firstColumn);
}

Eigen::Vector3d FineBlock::between(int column, int row) {
  const Eigen::Vector3f sum =
      node(column, row) + node(column + 1, row) + node(column, row + 1) + node(column + 1, row + 1);
  return 0.25 * sum.cast<double>();
}

void FineBlock::exclude(int column, int row) {
  const auto isWithin = [&](int place, int first) { return place >= first && place < first + m_side; };
  if (isWithin(column, m_firstColumn) && isWithin(row, m_firstRow)) {
    m_isGood[cellIndex(column, row)] = false;
  }
}

std::vector<float> FineBlock::emptyTable() {
  return std::vector<float>(placeOf(0, HomogeneousMap::kFineSide + 1));
}

void FineBlock::putInto(std::vector<float>& table) const {
  const float* from = m_nodes.data();
  for (int row = m_firstRow; row <= m_firstRow + m_side; ++row) {
    for (int column = m_firstColumn; column <= m_firstColumn + m_side; ++column, from += 3) {
      if (!std::isnan(*from)) {  // else another part's, or nobody's
        std::copy_n(from, 3, table.data() + placeOf(column, row));
      }
    }
  }
  for (int row = m_firstRow; row < m_firstRow + m_side; ++row) {
    for (int column = m_firstColumn; column < m_firstColumn + m_side; ++column) {
      table[placeOf(column, row) + 3] = m_isGood[cellIndex(column, row)] ? 0.0F : 1.0F;
    }
  }
}

}  // namespace metamer::sip
