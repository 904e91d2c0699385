// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/homogeneous_map.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <memory>
#include <memory_resource>
#include <optional>
#include <unordered_map>

#include "map/fine_table.h"
#include "metamer/spectral/argument_checks.h"
#include "transform/perceptual_metric.h"

namespace metamer::sip {

namespace {

using Map = HomogeneousMap;

/// Down to this level a patch is checked in the middles of its edges too: on a large cell the border of what
/// reflectances can make may pass the middle by.
constexpr int kEdgeCheckLevels = 3;

/// Of the tolerance, what the fine table may add to what the patches are off by.
constexpr double kFineShare = 0.5;

/// Cube coordinates from the white-normalised response (a, b, c): (2a - s, 2b - s, s), s the sum. On the front face
/// they are chromaticity stretched to -1 ... 1; all that reflectances can make lies there.
Eigen::Matrix3d cubeFromResponse() {
  Eigen::Matrix3d matrix;
  matrix << 1, -1, -1,  //
      -1, 1, -1,        //
      1, 1, 1;
  return matrix;
}

/// Scaled by a power of two so that no float32 colour's coordinates overflow.
Eigen::Matrix3d withoutOverflow(const Eigen::Matrix3d& cubeFromRgb) {
  int exponent = 0;
  std::frexp(cubeFromRgb.cwiseAbs().rowwise().sum().maxCoeff(), &exponent);
  return std::ldexp(1.0, -exponent) * cubeFromRgb;
}

/// Inscribed polygon with at most `most` corners: drops the corner that costs the least area, again and again.
std::vector<Eigen::Vector3d> inscribedPolygon(std::vector<Eigen::Vector3d> corners, const Eigen::Matrix3d& cubeFromRgb,
                                              std::size_t most) {
  const auto flat = [&](const Eigen::Vector3d& ray) {
    const Eigen::Vector3d p = cubeFromRgb * ray;
    return Eigen::Vector2d(p.head<2>() / p.z());
  };
  while (corners.size() > most) {
    std::size_t least = 0;
    double leastArea = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Eigen::Vector2d a = flat(corners[(i + corners.size() - 1) % corners.size()]);
      const Eigen::Vector2d b = flat(corners[i]);
      const Eigen::Vector2d c = flat(corners[(i + 1) % corners.size()]);
      const Eigen::Vector2d ab = b - a;
      const Eigen::Vector2d ac = c - a;
      const double area = std::abs(ab.x() * ac.y() - ab.y() * ac.x());
      if (area < leastArea) {
        leastArea = area;
        least = i;
      }
    }
    corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(least));
  }
  return corners;
}

/// Adini's element: twelve terms, each an RGB, in the order of HomogeneousMap::Patch.
using Adini = std::array<Eigen::Vector3d, 12>;

/// Power coefficients of the cubic with values a, b and derivatives da, db at 0 and 1.
std::array<Eigen::Vector3d, 4> hermite(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& da,
                                       const Eigen::Vector3d& db) {
  return {a, da, 3.0 * (b - a) - 2.0 * da - db, 2.0 * (a - b) + da + db};
}

Eigen::Vector3d evaluate(const Adini& patch, double u, double v) {
  const Eigen::Vector3d constant = ((patch[3] * u + patch[2]) * u + patch[1]) * u + patch[0];
  const Eigen::Vector3d linear = ((patch[7] * u + patch[6]) * u + patch[5]) * u + patch[4];
  return (((patch[11] * u + patch[10]) * v + (patch[9] * u + patch[8])) * v + linear) * v + constant;
}

/// What all parts of a map are built from.
struct Source {
  Source(const SpectralTransform& given, double givenTolerance)
      : transform(given),
        tolerance(givenTolerance),
        cubeFromRgb(withoutOverflow(cubeFromResponse() * given.responseFromRgb())),
        rgbFromCube(cubeFromRgb.inverse()),
        metric(given.space()) {}

  const SpectralTransform& transform;
  double tolerance;
  Eigen::Matrix3d cubeFromRgb;
  Eigen::Matrix3d rgbFromCube;
  PerceptualMetric metric;
};

/// Some rows of a face's root cells, with the patches they need. Built on its own, so that the threads that build the
/// parts cannot change what comes out.
class Part {
 public:
  Part(const Source& source, int face, int firstRow) : m_source(source), m_face(face), m_firstRow(firstRow) {
    if (face == Map::kFrontFace) {
      m_fine.emplace(firstRow * kFinePerRoot, kRows * kFinePerRoot);
    }
  }

  static constexpr int kRows = 2;

  void build() {
    m_table = std::make_unique<NodeTable>();
    const int side = 1 << Map::kRootBits[static_cast<std::size_t>(m_face)];
    for (int j = m_firstRow; j < m_firstRow + kRows; ++j) {
      for (int i = 0; i < side; ++i) {
        addRoot(i, j);
      }
    }
    for (const Smooth& smooth : m_smooth) {
      m_fine->check(
          smooth.square, [&](double u, double v) { return evaluate(smooth.patch, u, v); }, smooth.metrics,
          kFineShare * m_source.tolerance);
    }
    m_smooth.clear();
    m_table.reset();
  }

  /// Appends the part to a map, in the order of faces and rows.
  void appendTo(Map& map) const {
    const auto firstIndex = static_cast<std::uint32_t>(map.patchIndex.size());
    const auto firstPatch = static_cast<std::uint32_t>(map.patches.size());
    for (const std::uint32_t root : m_roots) {
      map.roots.push_back(root + (firstIndex << Map::kDepthBits));
    }
    for (const std::uint32_t patch : m_patchIndex) {
      map.patchIndex.push_back(patch + firstPatch);
    }
    map.patches.insert(map.patches.end(), m_patches.begin(), m_patches.end());
    if (m_fine) {
      m_fine->appendTo(map.fine);
    }
    map.statistics.solves += m_statistics.solves;
    map.statistics.patches += m_statistics.patches;
    map.statistics.largestError = std::max(map.statistics.largestError, m_statistics.largestError);
  }

 private:
  /// The transform at a point of a face, as a function of the face's coordinates.
  struct Node {
    Eigen::Vector3d value;
    ClampedBands clamped;
    Eigen::Vector3d alongU;  ///< derivative per unit of the first face coordinate
    Eigen::Vector3d alongV;
    Eigen::Matrix3d metric;  ///< length of metric * error is about CIEDE2000
  };
  struct Placed {
    int level;
    int i;
    int j;
    std::uint32_t patch;
  };

  /// Position in units of half the finest cell, with a node close by.
  const Node& node(int u, int v, const Node& near) {
    const std::uint64_t key = (static_cast<std::uint64_t>(u) << 20) | static_cast<std::uint64_t>(v);
    const auto [place, isNew] = m_table->nodes.try_emplace(key);
    Node& made = place->second;
    if (!isNew) {
      return made;
    }
    const int steps = 1 << (Map::kRootBits[static_cast<std::size_t>(m_face)] + Map::kMaximumDepth + 1);
    const int axis = m_face / 2;
    Eigen::Vector3d cube;
    cube[axis] = m_face % 2 == 0 ? 1.0 : -1.0;
    cube[(axis + 1) % 3] = 2.0 * u / steps - 1.0;
    cube[(axis + 2) % 3] = 2.0 * v / steps - 1.0;
    const Eigen::Vector3d rgb = m_source.rgbFromCube * cube;
    const SpectralTransform::Linearisation exact = m_source.transform.linearise(rgb, &near.clamped);
    made.value = exact.value;
    made.clamped = exact.clamped;
    made.alongU = exact.matrix * m_source.rgbFromCube.col((axis + 1) % 3);
    made.alongV = exact.matrix * m_source.rgbFromCube.col((axis + 2) % 3);
    made.metric = m_source.metric.at(rgb, made.value);
    ++m_statistics.solves;
    return made;
  }

  /// The element over the corners (low-low, high-low, low-high, high-high): a cubic along each edge by the values and
  /// derivatives at its ends. Neighbours of one size share their edge exactly.
  static Adini adiniPatch(const std::array<const Node*, 4>& corner, double side) {
    const auto alongU = [&](std::size_t from, std::size_t to) {
      return hermite(corner[from]->value, corner[to]->value, side * corner[from]->alongU, side * corner[to]->alongU);
    };
    const auto alongV = [&](std::size_t from, std::size_t to) {
      return hermite(corner[from]->value, corner[to]->value, side * corner[from]->alongV, side * corner[to]->alongV);
    };
    const auto bottom = alongU(0, 1);
    const auto top = alongU(2, 3);
    const auto left = alongV(0, 2);
    const auto right = alongV(1, 3);
    const Eigen::Vector3d twist = corner[3]->value - corner[2]->value - corner[1]->value + bottom[0];
    Adini patch{bottom[0],          bottom[1],          bottom[2], bottom[3],          left[1], {},
                top[2] - bottom[2], top[3] - bottom[3], left[2],   right[2] - left[2], left[3], right[3] - left[3]};
    patch[5] = twist - patch[6] - patch[7] - patch[9] - patch[11];
    return patch;
  }

  /// Error of a patch at a checked point over the tolerance there.
  double excess(const Adini& patch, const Node& at, double u, double v) const {
    return (at.metric * (evaluate(patch, u, v) - at.value)).norm() / m_source.tolerance;
  }

  /// @param u, v, side  corner and side in units of 1 / steps of the face
  std::uint32_t store(const Adini& adini, int u, int v, int side, int steps) {
    const auto index = static_cast<std::uint32_t>(m_patches.size());
    Map::Patch& patch = m_patches.emplace_back();
    for (std::size_t term = 0; term < adini.size(); ++term) {
      Eigen::Map<Eigen::Vector3f>(patch.coefficients.data() + 3 * term) = adini[term].cast<float>();
    }
    // All exact: powers of two, and multiples of them.
    const std::array<float, 2> low = {static_cast<float>(u) / static_cast<float>(steps),
                                      static_cast<float>(v) / static_cast<float>(steps)};
    const int perUnit = steps / side;
    patch.scale = static_cast<float>(perUnit);
    for (std::size_t k = 0; k < 2; ++k) {
      patch.offset[k] = (0.5F - low[k]) * patch.scale;
    }
    ++m_statistics.patches;
    return index;
  }

  /// Corner (u, v) and side of a cell in half finest cells.
  void refine(int u, int v, int side, int level, int i, int j, std::vector<Placed>& placed) {
    const Node& first = node(u, v, *m_latest);
    m_latest = &first;
    const Node& second = node(u + side, v, first);
    const Node& third = node(u, v + side, first);
    const Node& fourth = node(u + side, v + side, second);
    const int steps = 1 << (Map::kRootBits[static_cast<std::size_t>(m_face)] + Map::kMaximumDepth + 1);
    const Adini patch = adiniPatch({&first, &second, &third, &fourth}, 2.0 * side / steps);
    const int half = side / 2;
    // The middle first: most patches that fail, fail there.
    double worst = excess(patch, node(u + half, v + half, first), 0.5, 0.5);
    const bool deepest = level == Map::kDepthLimit[static_cast<std::size_t>(m_face)];
    if ((worst <= 1.0 && level < kEdgeCheckLevels) || (worst > 1.0 && !deepest)) {
      // Also the corners of the four parts, should there be any.
      worst = std::max({worst, excess(patch, node(u + half, v, first), 0.5, 0.0),
                        excess(patch, node(u, v + half, first), 0.0, 0.5),
                        excess(patch, node(u + side, v + half, second), 1.0, 0.5),
                        excess(patch, node(u + half, v + side, third), 0.5, 1.0)});
    }
    if (worst <= 1.0 || deepest) {
      m_statistics.largestError = std::max(m_statistics.largestError, worst * m_source.tolerance);
      placed.push_back({level, i, j, store(patch, u, v, side, steps)});
      const int cell = steps / Map::kFineSide;
      if (m_fine && side >= cell) {
        const auto metric = [](const Node& at) { return &at.metric; };
        const Smooth& smooth = m_smooth.emplace_back(Smooth{
            {u / cell, v / cell, side / cell}, patch, {metric(first), metric(second), metric(third), metric(fourth)}});
        m_fine->fill(smooth.square, [&](double s, double t) { return evaluate(smooth.patch, s, t); });
      }
      return;
    }
    for (int dj = 0; dj < 2; ++dj) {
      for (int di = 0; di < 2; ++di) {
        refine(u + di * half, v + dj * half, half, level + 1, 2 * i + di, 2 * j + dj, placed);
      }
    }
  }

  void addRoot(int i, int j) {
    constexpr int kSide = 1 << (Map::kMaximumDepth + 1);
    std::vector<Placed> placed;
    refine(i * kSide, j * kSide, kSide, 0, 0, 0, placed);
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
    FineRows::Square square;
    Adini patch;
    std::array<const Eigen::Matrix3d*, 4> metrics;
  };

  static constexpr int kFinePerRoot = Map::kFineSide >> Map::kRootBits[Map::kFrontFace];

  const Source& m_source;
  int m_face;
  int m_firstRow;
  std::vector<std::uint32_t> m_roots;
  std::vector<std::uint32_t> m_patchIndex;
  std::vector<Map::Patch> m_patches;
  std::optional<FineRows> m_fine;
  std::vector<Smooth> m_smooth;
  Map::Statistics m_statistics;
  /// Nodes by position. None is dropped before all are.
  struct NodeTable {
    std::pmr::monotonic_buffer_resource memory;
    std::pmr::unordered_map<std::uint64_t, Node> nodes{&memory};
  };
  std::unique_ptr<NodeTable> m_table;
  Node m_none;  // guesses nothing
  const Node* m_latest = &m_none;
};

void addLinearCone(const Source& source, Map& map) {
  const auto corners =
      inscribedPolygon(source.transform.linearConeCorners(), source.cubeFromRgb, Map::kMostLinearNormals);
  if (corners.size() < 3) {
    return;
  }
  map.linearNormalCount = static_cast<int>(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    Eigen::Vector3d normal = corners[i].cross(corners[(i + 1) % corners.size()]).normalized();
    if (normal.sum() < 0.0) {  // neutral (1, 1, 1) is inside
      normal = -normal;
    }
    Eigen::Map<Eigen::Vector3f>(map.linearNormals.data() + 3 * i) = normal.cast<float>();
  }
}

}  // namespace

HomogeneousMap buildHomogeneousMap(const SpectralTransform& transform, double tolerance,
                                   const ParallelFor& parallelFor) {
  spectral::requireAbove("tolerance", tolerance, 0.0);
  Map map;
  map.identity = transform.isIdentity();
  if (map.identity) {
    return map;
  }
  const Source source(transform, tolerance);
  Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(map.cubeFromRgb.data()) = source.cubeFromRgb.cast<float>();
  Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(map.linearMatrix.data()) =
      transform.linearMatrix().cast<float>();
  addLinearCone(source, map);
  map.fine = FineRows::emptyTable();
  std::deque<Part> parts;  // which hold pointers into themselves
  std::uint32_t rootCount = 0;
  for (int face = 0; face < Map::kFaceCount; ++face) {
    const int side = 1 << Map::kRootBits[static_cast<std::size_t>(face)];
    map.faceOffset[static_cast<std::size_t>(face)] = rootCount;
    rootCount += static_cast<std::uint32_t>(side * side);
    for (int row = 0; row < side; row += Part::kRows) {
      parts.emplace_back(source, face, row);
    }
  }
  parallelFor(static_cast<int>(parts.size()), [&](int part) { parts[static_cast<std::size_t>(part)].build(); });
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
