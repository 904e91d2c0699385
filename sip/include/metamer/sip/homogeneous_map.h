// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "metamer/sip/map_memory.h"
#include "metamer/sip/spectral_transform.h"

namespace metamer::sip {

/// A spectral transform as a two-dimensional table: fast, and exposure-invariant like the transform itself.
///
/// The transform is homogeneous of degree one, so it is known everywhere once it is known on the directions of RGB
/// space. Directions are the faces of a cube in coordinates `p = cubeFromRgb * rgb`: a pixel is its largest |p| times
/// a point of a face. Each face is a grid of root cells, each root cell a dense table of patches 2^depth by 2^depth.
/// A patch is a cubic (Adini's element) in the face's two coordinates, built from the transform's exact values and
/// derivatives at its corners and checked between them. Where the transform is one matrix (scene smooth, no band
/// clamped, nothing limited), the kernel skips the table and applies that matrix.
///
/// Plain buffers without pointers, ready to be copied to another device. Immutable after build.
struct HomogeneousMap {
  static constexpr int kFaceCount = 6;
  static constexpr int kFrontFace = 4;  ///< +p[2]: every real colour; the others hold what is beyond all lights
  static constexpr int kDepthBits = 3;
  static constexpr int kMaximumDepth = 7;
  static constexpr std::array<int, kFaceCount> kRootBits = {2, 2, 2, 2, 4, 2};  ///< log2 of a side's root cells
  /// What lies beyond all lights is continuous and bounded there, and needs no more.
  static constexpr std::array<int, kFaceCount> kDepthLimit = {3, 3, 3, 3, kMaximumDepth, 3};
  /// Twelve terms, each red, green, blue, in units of a pixel whose largest |p| is 1. Powers of u (0 ... 3) with v^0,
  /// then with v^1; then (0, 1) with v^2 and with v^3: all that Adini's element has. (u, v), 0 ... 1 over the patch, is
  /// scale * (x, y) + offset, where (x, y), -0.5 ... 0.5, are half the face coordinates.
  struct Patch {
    std::array<float, 36> coefficients;
    float scale;
    std::array<float, 2> offset;
  };
  static constexpr std::size_t kMostLinearNormals = 8;
  static constexpr int kFineBits = 8;
  static constexpr int kFineSide = 1 << kFineBits;  ///< cells

  std::array<float, 9> cubeFromRgb{};   ///< rows
  std::array<float, 9> linearMatrix{};  ///< rows; exact inside the linear cone
  /// The linear cone: n . rgb >= 0 for all. Count 0: there is none.
  std::array<float, 3 * kMostLinearNormals> linearNormals{};
  int linearNormalCount = 0;
  bool identity = false;             ///< apply() copies
  std::vector<std::uint32_t> roots;  ///< face by face, row by row: start in patchIndex << kDepthBits | depth
  std::array<std::uint32_t, kFaceCount> faceOffset{};  ///< of a face's first root
  std::vector<std::uint32_t> patchIndex;               ///< dense tables of the root cells
  std::vector<Patch> patches;
  /// The front face as even nodes, kFineSide + 1 a row, row by row: red, green, blue at length 1, and 0 where the cell
  /// that begins at the node is within the tolerance between its nodes (bilinear), else 1. Pixels in such cells take
  /// their value from it, the others from their patches. It lies in a processor's second cache, and the part of it that
  /// a picture takes in its first.
  std::vector<float> fine;

  /// What the build did.
  struct Statistics {
    int solves = 0;  ///< exact colours computed
    int patches = 0;
    double largestError = 0;  ///< at the checked points, approximate CIEDE2000 at Y = 0.18; 0 where none were checked
  };
  Statistics statistics;

  /// Applies to rgba.size() / 4 pixels in place; alpha is left alone. The result of a pixel does not depend on its
  /// neighbours, the length of the span or the instruction set. A pixel with a NaN or infinite component is left
  /// unchanged. `source` and `destination` are equal or apart. @throws spectral::InputError: lengths differ, half a
  /// pixel
  void apply(std::span<const float> source, std::span<float> destination) const;
  void apply(std::span<float> rgba) const { apply(rgba, rgba); }
};

/// Default tolerance of a map: what keeps its 99th percentile under a tenth of a CIEDE2000.
inline constexpr double kDefaultMapTolerance = 0.06;

/// Calls body(0) ... body(count - 1), in any order and on any threads, and returns when all have returned.
using ParallelFor = std::function<void(int count, const std::function<void(int)>& body)>;

/// One after another on this thread.
void inOrder(int count, const std::function<void(int)>& body);

/// Builds the map of a transform, the same whatever the threads.
/// @param tolerance  above 0: CIEDE2000 at Y = 0.18, relative to the working white, at each patch's checked points.
///                   Patches at the greatest depth may exceed it (statistics.largestError says by how much).
/// @param parallelFor  runs the parts of the map
/// @param memory       of maps before; may be null
/// @param fewerLevels  0 ... kMaximumDepth: levels of patches that are left out, the finest first. Coarser where the
///                     transform bends most, and sooner there. At 3 no patch is smaller than a cell of the fine table.
///                     At kMaximumDepth no point is checked: a draft, in a tenth of the time.
/// @throws spectral::InputError where the tolerance is not above 0, or the levels are out of range
HomogeneousMap buildHomogeneousMap(const SpectralTransform& transform, double tolerance = kDefaultMapTolerance,
                                   const ParallelFor& parallelFor = inOrder, const MapMemory* memory = nullptr,
                                   int fewerLevels = 0);

}  // namespace metamer::sip
