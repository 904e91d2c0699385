// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <vector>

#include "metamer/sip/homogeneous_map.h"

namespace metamer::sip {

/// A square of HomogeneousMap::fine, from the patches that lie there.
class FineBlock {
 public:
  /// @param firstColumn, firstRow, side  of cells
  FineBlock(int firstColumn, int firstRow, int side);

  /// A square of cells under one patch, in cells of the whole table.
  struct Square {
    int column;
    int row;
    int side;
  };
  /// Fills a square's nodes.
  /// @param value  the patch at (u, v), 0 ... 1: an RGB
  template <typename Value>
  void fill(const Square& square, const Value& value) {
    for (int j = 0; j <= square.side; ++j) {
      for (int i = 0; i <= square.side; ++i) {
        node(square.column + i, square.row + j) =
            value(static_cast<double>(i) / square.side, static_cast<double>(j) / square.side).template cast<float>();
      }
    }
  }
  /// Once all are filled: finds the square's cells that are within the tolerance between their nodes.
  /// @param metrics  at the square's corners, the strictest of which counts: the length of metric * error is about
  ///                 CIEDE2000
  template <typename Value>
  void check(const Square& square, const Value& value, const std::array<const Eigen::Matrix3d*, 4>& metrics,
             double tolerance) {
    const auto middle = [&](int cell) { return (cell + 0.5) / square.side; };
    for (int j = 0; j < square.side; ++j) {
      for (int i = 0; i < square.side; ++i) {
        const Eigen::Vector3d error = between(square.column + i, square.row + j) - value(middle(i), middle(j));
        m_isGood[cellIndex(square.column + i, square.row + j)] =
            std::all_of(metrics.begin(), metrics.end(),
                        [&](const Eigen::Matrix3d* metric) { return (*metric * error).norm() <= tolerance; });
      }
    }
  }

  /// Leaves a cell to the patches, as where they are within the tolerance at one point and it is not. A cell of other
  /// blocks is none of these.
  void exclude(int column, int row);

  /// Puts the block into a table of all nodes; where blocks meet, the latter's values stand if it has any.
  void putInto(std::vector<float>& table) const;
  /// What putInto() takes at first.
  static std::vector<float> emptyTable();

 private:
  Eigen::Map<Eigen::Vector3f> node(int column, int row);
  std::size_t cellIndex(int column, int row) const;
  /// The table in the middle of a cell.
  Eigen::Vector3d between(int column, int row);

  int m_firstColumn;
  int m_firstRow;
  int m_side;
  std::vector<float> m_nodes;  ///< three floats each; NaN where none is filled
  std::vector<bool> m_isGood;  ///< cells
};

}  // namespace metamer::sip
