// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/homogeneous_map.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <optional>
#include <tuple>

#include "map/adini_element.h"
#include "map/face_nodes.h"
#include "map/fine_block.h"
#include "map/linear_cone.h"
#include "map/map_memory_state.h"
#include "map/map_source.h"
#include "metamer/spectral/argument_checks.h"

namespace metamer::sip {

namespace {

using Map = HomogeneousMap;

/// Down to this level a patch is checked in the middles of its edges too: on a large cell the border of what
/// reflectances can make may pass the middle by.
constexpr int kEdgeCheckLevels = 3;

/// A square of a face's root cells, with the patches they need. Built on its own, so that the threads that build the
/// parts cannot change what comes out.
class Part {
 public:
  Part(const MapSource& source, int face, int firstColumn, int firstRow, int side)
      : m_source(source), m_face(face), m_firstColumn(firstColumn), m_firstRow(firstRow), m_side(side) {
    if (face == Map::kFrontFace) {
      m_fine.emplace(firstColumn * kFinePerRoot, firstRow * kFinePerRoot, side * kFinePerRoot);
    }
  }

  /// Root cells along a part. Few, as most of a map's work may lie in a few of them; of a draft all, as neighbouring
  /// parts solve the nodes between them twice.
  static int sideOf(const MapSource& source, int face) {
    return source.isDraft() ? 1 << Map::kRootBits[static_cast<std::size_t>(face)] : 2;
  }

  /// @param memory  of this part; may be null
  void build(PartMemory* memory) {
    m_nodes = std::make_unique<FaceNodes>(m_source, m_face, memory);
    constexpr int kRootSteps = 1 << (Map::kMaximumDepth + 1);
    std::vector<std::size_t> open;  // cells that are not judged yet, all of one level
    for (int j = m_firstRow; j < m_firstRow + m_side; ++j) {
      for (int i = m_firstColumn; i < m_firstColumn + m_side; ++i) {
        open.push_back(m_cells.size());
        m_cells.push_back({i * kRootSteps, j * kRootSteps, kRootSteps});
      }
    }
    const std::size_t rootCount = open.size();
    while (!open.empty()) {
      open = judged(open);
    }
    for (std::size_t root = 0; root < rootCount; ++root) {
      addRoot(root);
    }
    for (const Smooth& smooth : m_smooth) {
      m_fine->check(
          smooth.square, [&](double u, double v) { return evaluate(smooth.patch, u, v); }, smooth.metrics,
          m_source.tolerance);
    }
    if (m_fine) {
      for (const KnownPoint& known : m_source.known) {
        const Eigen::Vector2d cell = (Map::kFineSide * known.place).array().min(Map::kFineSide - 0.5);
        m_fine->exclude(static_cast<int>(cell.x()), static_cast<int>(cell.y()));
      }
    }
    m_smooth.clear();
    m_cells.clear();
    m_statistics.solves = m_nodes->solveCount();
    m_nodes.reset();
  }

  /// Puts the part into a map whose roots and fine table have their room.
  void appendTo(Map& map) const {
    const auto firstIndex = static_cast<std::uint32_t>(map.patchIndex.size());
    const auto firstPatch = static_cast<std::uint32_t>(map.patches.size());
    const auto face = static_cast<std::size_t>(m_face);
    auto own = m_roots.begin();
    for (int row = m_firstRow; row < m_firstRow + m_side; ++row) {
      for (int column = m_firstColumn; column < m_firstColumn + m_side; ++column) {
        const auto root = static_cast<std::uint32_t>((row << Map::kRootBits[face]) + column);
        map.roots[map.faceOffset[face] + root] = *own++ + (firstIndex << Map::kDepthBits);
      }
    }
    for (const std::uint32_t patch : m_patchIndex) {
      map.patchIndex.push_back(patch + firstPatch);
    }
    map.patches.insert(map.patches.end(), m_patches.begin(), m_patches.end());
    if (m_fine) {
      m_fine->putInto(map.fine);
    }
    map.statistics.solves += m_statistics.solves;
    map.statistics.patches += m_statistics.patches;
    map.statistics.largestError = std::max(map.statistics.largestError, m_statistics.largestError);
  }

 private:
  /// A square of a face: a patch, or four smaller ones. Lengths are in half finest cells.
  struct Cell {
    int u;
    int v;
    int side;
    int level = 0;
    std::size_t firstPart = 0;  ///< of four; 0: none
    double excess = 0.0;        ///< largest error at the checked points, over the tolerance
    std::array<FaceNode*, 4> corners = {};
    Adini patch = {};
  };
  struct Placed {
    int level;
    int i;
    int j;
    std::uint32_t patch;
  };

  /// Of the colours whose spectra are known, in a cell.
  double excessAtKnown(const Cell& cell) const {
    double most = 0.0;
    for (const KnownPoint& known : m_source.known) {
      const Eigen::Vector2d at = (m_nodes->steps() * known.place - Eigen::Vector2d(cell.u, cell.v)) / cell.side;
      if (at.minCoeff() >= 0.0 && at.maxCoeff() <= 1.0) {
        const Eigen::Vector3d error = evaluate(cell.patch, at.x(), at.y()) - known.value;
        most = std::max(most, (known.metric * error).norm() / m_source.tolerance);
      }
    }
    return most;
  }

  Adini patchOver(const Cell& cell) const {
    const auto corner = [&](std::size_t k) {
      const FaceNode& node = *cell.corners[k];
      return AdiniCorner{node.point.value, node.alongU, node.alongV};
    };
    return adiniElement({corner(0), corner(1), corner(2), corner(3)}, 2.0 * cell.side / m_nodes->steps());
  }

  /// Error of a patch at a checked point over the tolerance there.
  double excess(const Adini& patch, const FaceNode& at, double u, double v) const {
    return (at.metric * (evaluate(patch, u, v) - at.point.value)).norm() / m_source.tolerance;
  }

  std::uint32_t store(const Cell& cell) {
    const auto index = static_cast<std::uint32_t>(m_patches.size());
    Map::Patch& patch = m_patches.emplace_back();
    for (std::size_t term = 0; term < cell.patch.size(); ++term) {
      Eigen::Map<Eigen::Vector3f>(patch.coefficients.data() + 3 * term) = cell.patch[term].cast<float>();
    }
    // All exact: powers of two, and multiples of them.
    const std::array<float, 2> low = {static_cast<float>(cell.u) / static_cast<float>(m_nodes->steps()),
                                      static_cast<float>(cell.v) / static_cast<float>(m_nodes->steps())};
    const int perUnit = m_nodes->steps() / cell.side;
    patch.scale = static_cast<float>(perUnit);
    for (std::size_t k = 0; k < 2; ++k) {
      patch.offset[k] = (0.5F - low[k]) * patch.scale;
    }
    ++m_statistics.patches;
    return index;
  }

  bool isDeepest(const Cell& cell) const {
    return cell.level >= Map::kDepthLimit[static_cast<std::size_t>(m_face)] - m_source.fewerLevels;
  }
  /// A cell whose middle does not settle it is checked on its edges: also the corners of the four parts, should there
  /// be any.
  bool needsEdges(const Cell& cell) const {
    return (cell.excess <= 1.0 && cell.level < kEdgeCheckLevels - m_source.fewerLevels) ||
           (cell.excess > 1.0 && !isDeepest(cell));
  }

  /// Judges cells of one level. @return the parts of those that are not good enough
  std::vector<std::size_t> judged(const std::vector<std::size_t>& cells) {
    // The middle first: most patches that fail, fail there.
    std::vector<const FaceNode*> middles;
    for (const std::size_t index : cells) {
      Cell& cell = m_cells[index];
      const auto [u, v, side] = std::tuple(cell.u, cell.v, cell.side);
      cell.corners = {m_nodes->at(u, v), m_nodes->at(u + side, v), m_nodes->at(u, v + side),
                      m_nodes->at(u + side, v + side)};
      if (!m_source.isDraft()) {
        middles.push_back(m_nodes->at(u + side / 2, v + side / 2));
      }
    }
    m_nodes->solve();
    std::vector<std::array<const FaceNode*, 4>> edges;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      Cell& cell = m_cells[cells[k]];
      for (FaceNode* corner : cell.corners) {
        m_nodes->addSlopes(*corner);
      }
      cell.patch = patchOver(cell);
      if (m_source.isDraft()) {
        continue;
      }
      cell.excess = excess(cell.patch, *middles[k], 0.5, 0.5);
      if (m_face == Map::kFrontFace) {
        cell.excess = std::max(cell.excess, excessAtKnown(cell));
      }
      if (needsEdges(cell)) {
        const auto [u, v, side] = std::tuple(cell.u, cell.v, cell.side);
        edges.push_back({m_nodes->at(u + side / 2, v), m_nodes->at(u, v + side / 2),
                         m_nodes->at(u + side, v + side / 2), m_nodes->at(u + side / 2, v + side)});
      }
    }
    if (m_source.isDraft()) {
      return {};
    }
    m_nodes->solve();
    std::vector<std::size_t> parts;
    auto edge = edges.begin();
    for (const std::size_t index : cells) {
      if (needsEdges(m_cells[index])) {
        Cell& cell = m_cells[index];
        const auto& [low, left, right, high] = *edge++;
        cell.excess = std::max({cell.excess, excess(cell.patch, *low, 0.5, 0.0), excess(cell.patch, *left, 0.0, 0.5),
                                excess(cell.patch, *right, 1.0, 0.5), excess(cell.patch, *high, 0.5, 1.0)});
      }
      if (m_cells[index].excess > 1.0 && !isDeepest(m_cells[index])) {
        const int half = m_cells[index].side / 2;
        m_cells[index].firstPart = m_cells.size();
        for (const int dv : {0, half}) {
          for (const int du : {0, half}) {
            parts.push_back(m_cells.size());
            m_cells.push_back({m_cells[index].u + du, m_cells[index].v + dv, half, m_cells[index].level + 1});
          }
        }
      }
    }
    return parts;
  }

  /// Stores the patches of a cell. @param i, j  of the cell among those of its level in its root
  void place(const Cell& cell, int i, int j, std::vector<Placed>& placed) {
    if (cell.firstPart != 0) {
      for (int part = 0; part < 4; ++part) {
        place(m_cells[cell.firstPart + static_cast<std::size_t>(part)], 2 * i + part % 2, 2 * j + part / 2, placed);
      }
      return;
    }
    m_statistics.largestError = std::max(m_statistics.largestError, cell.excess * m_source.tolerance);
    placed.push_back({cell.level, i, j, store(cell)});
    const int fine = m_nodes->steps() / Map::kFineSide;
    if (m_fine && cell.side >= fine) {
      const auto& corners = cell.corners;
      const Smooth& smooth = m_smooth.emplace_back(
          Smooth{{cell.u / fine, cell.v / fine, cell.side / fine},
                 cell.patch,
                 {&corners[0]->metric, &corners[1]->metric, &corners[2]->metric, &corners[3]->metric}});
      m_fine->fill(smooth.square, [&](double s, double t) { return evaluate(smooth.patch, s, t); });
    }
  }

  void addRoot(std::size_t root) {
    std::vector<Placed> placed;
    place(m_cells[root], 0, 0, placed);
    int depth = 0;
    for (const Placed& patch : placed) {
      depth = std::max(depth, patch.level);
    }
    const auto first = static_cast<std::uint32_t>(m_patchIndex.size());
    const int side = 1 << depth;
    m_patchIndex.resize(first + static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    for (const Placed& patch : placed) {
      const int span = 1 << (depth - patch.level);
      for (int row = patch.j * span; row < (patch.j + 1) * span; ++row) {
        for (int column = patch.i * span; column < (patch.i + 1) * span; ++column) {
          m_patchIndex[first + static_cast<std::size_t>(row * side + column)] = patch.patch;
        }
      }
    }
    m_roots.push_back((first << Map::kDepthBits) | static_cast<std::uint32_t>(depth));
  }

  /// A patch that is no smaller than a cell of the fine table.
  struct Smooth {
    FineBlock::Square square;
    Adini patch;
    std::array<const Eigen::Matrix3d*, 4> metrics;
  };

  static constexpr int kFinePerRoot = Map::kFineSide >> Map::kRootBits[Map::kFrontFace];

  const MapSource& m_source;
  int m_face;
  int m_firstColumn;
  int m_firstRow;
  int m_side;  ///< root cells
  std::vector<std::uint32_t> m_roots;
  std::vector<std::uint32_t> m_patchIndex;
  std::vector<Map::Patch> m_patches;
  std::optional<FineBlock> m_fine;
  std::vector<Smooth> m_smooth;
  Map::Statistics m_statistics;
  std::unique_ptr<FaceNodes> m_nodes;
  std::vector<Cell> m_cells;  // roots first
};

}  // namespace

HomogeneousMap buildHomogeneousMap(const SpectralTransform& transform, double tolerance, const ParallelFor& parallelFor,
                                   const MapMemory* memory, int fewerLevels) {
  spectral::requireAbove("tolerance", tolerance, 0.0);
  spectral::requireWithin("fewerLevels", fewerLevels, 0, Map::kMaximumDepth);
  Map map;
  map.identity = transform.isIdentity();
  if (map.identity) {
    return map;
  }
  const MapSource source(transform, tolerance, fewerLevels);
  Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(map.cubeFromRgb.data()) = source.cubeFromRgb.cast<float>();
  Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(map.linearMatrix.data()) =
      transform.linearMatrix().cast<float>();
  addLinearCone(transform, source.cubeFromRgb, map);
  map.fine = FineBlock::emptyTable();
  std::deque<Part> parts;  // which hold pointers into themselves
  std::uint32_t rootCount = 0;
  for (int face = 0; face < Map::kFaceCount; ++face) {
    const int side = 1 << Map::kRootBits[static_cast<std::size_t>(face)];
    const int partSide = Part::sideOf(source, face);
    map.faceOffset[static_cast<std::size_t>(face)] = rootCount;
    rootCount += static_cast<std::uint32_t>(side * side);
    for (int row = 0; row < side; row += partSide) {
      for (int column = 0; column < side; column += partSide) {
        parts.emplace_back(source, face, column, row, partSide);
      }
    }
  }
  map.roots.resize(rootCount);
  if (memory == nullptr) {
    parallelFor(static_cast<int>(parts.size()),
                [&](int part) { parts[static_cast<std::size_t>(part)].build(nullptr); });
  } else {
    const auto kept = memory->state().partsFor(transform, parts.size());
    parallelFor(static_cast<int>(parts.size()), [&](int part) {
      PartMemory& known = (*kept)[static_cast<std::size_t>(part)];
      const std::lock_guard lock(known.mutex);
      parts[static_cast<std::size_t>(part)].build(&known);
    });
  }
  for (const Part& part : parts) {
    part.appendTo(map);
  }
  return map;
}

void inOrder(int count, const std::function<void(int)>& body) {
  for (int i = 0; i < count; ++i) {
    body(i);
  }
}

}  // namespace metamer::sip
