// SPDX-License-Identifier: Apache-2.0
#include "map/fine_table.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace metamer::sip {

namespace {

constexpr int kSide = HomogeneousMap::kFineSide;

constexpr std::size_t nodesOf(int rows) {
  return static_cast<std::size_t>(rows) * (kSide + 1);
}

}  // namespace

FineRows::FineRows(int firstRow, int rowCount)
    : m_firstRow(firstRow),
      m_rowCount(rowCount),
      m_nodes(3 * nodesOf(rowCount + 1), std::numeric_limits<float>::quiet_NaN()),
      m_isGood(static_cast<std::size_t>(rowCount) * kSide) {}

Eigen::Map<Eigen::Vector3f> FineRows::node(int column, int row) {
  return Eigen::Map<Eigen::Vector3f>(m_nodes.data() +
                                     3 * (nodesOf(row - m_firstRow) + static_cast<std::size_t>(column)));
}

std::size_t FineRows::cellIndex(int column, int row) const {
  return static_cast<std::size_t>(row - m_firstRow) * kSide + static_cast<std::size_t>(column);
}

Eigen::Vector3d FineRows::between(int column, int row) {
  const Eigen::Vector3f sum =
      node(column, row) + node(column + 1, row) + node(column, row + 1) + node(column + 1, row + 1);
  return 0.25 * sum.cast<double>();
}

std::vector<float> FineRows::emptyTable() {
  return std::vector<float>(4 * nodesOf(kSide + 1));
}

void FineRows::appendTo(std::vector<float>& table) const {
  const auto place = [&](int column, int row) { return 4 * (nodesOf(row) + static_cast<std::size_t>(column)); };
  for (int row = m_firstRow; row <= m_firstRow + m_rowCount; ++row) {
    for (int column = 0; column <= kSide; ++column) {
      const float* from = m_nodes.data() + 3 * (nodesOf(row - m_firstRow) + static_cast<std::size_t>(column));
      if (!std::isnan(*from)) {  // else another part's, or nobody's
        std::copy_n(from, 3, table.data() + place(column, row));
      }
    }
  }
  for (int row = m_firstRow; row < m_firstRow + m_rowCount; ++row) {
    for (int column = 0; column < kSide; ++column) {
      table[place(column, row) + 3] = m_isGood[cellIndex(column, row)] ? 0.0F : 1.0F;
    }
  }
}

}  // namespace metamer::sip
