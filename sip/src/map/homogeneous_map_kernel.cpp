// SPDX-License-Identifier: Apache-2.0
// The map's pixel kernel, compiled once an instruction set by Highway and chosen at run time.
//
// Every result is the same sequence of float32 operations whatever the instruction set and whichever pixels lie beside
// it, so neighbours, tails and machines cannot change it.
//
// A vector of pixels takes the one matrix where that is exact. For the rest the patches are looked up together, and as
// neighbours mostly share one, the patch of the first pixel left is evaluated for all that lie on it, its coefficients
// the same for every lane, until none is left.
#include "metamer/sip/homogeneous_map.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "map/homogeneous_map_kernel.cpp"
#include <hwy/foreach_target.h>
// Highway needs the target list first.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

#include "vector/choose_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::sip {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Map = HomogeneousMap;

constexpr std::size_t kMostLanes = 16;
using Float = hn::CappedTag<float, kMostLanes>;
using Int = hn::RebindToSigned<Float>;
using V = hn::VFromD<Float>;
using I = hn::VFromD<Int>;
using Mask = hn::Mask<Float>;

/// Keeps the reciprocal of a denormal finite: such a pixel's place is off, by less than it is bright.
constexpr float kSmallest = std::numeric_limits<float>::min();
constexpr float kBelowTwo = 2.0F - std::numeric_limits<float>::epsilon();
constexpr int kMantissaBits = 23;
/// How far ahead memory is asked for: 4 KiB.
constexpr std::size_t kPrefetchedPixels = 256;

/// a * b + c, rounded once.
HWY_INLINE V fused(V a, V b, V c) {
#if HWY_NATIVE_FMA
  return hn::MulAdd(a, b, c);
#else  // slowly, for processors of before 2013
  const Float d;
  HWY_ALIGN std::array<float, kMostLanes> x;
  HWY_ALIGN std::array<float, kMostLanes> y;
  HWY_ALIGN std::array<float, kMostLanes> z;
  hn::Store(a, d, x.data());
  hn::Store(b, d, y.data());
  hn::Store(c, d, z.data());
  for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
    z[lane] = std::fma(x[lane], y[lane], z[lane]);
  }
  return hn::Load(d, z.data());
#endif
}

HWY_INLINE V dot(const float* row, V x, V y, V z) {
  const Float d;
  return fused(hn::Set(d, row[2]), z, fused(hn::Set(d, row[1]), y, hn::Mul(hn::Set(d, row[0]), x)));
}

/// Four vectors of whole pixels into one a channel, or back. Lanes are then not in the pixels' order, which matters to
/// nothing here.
HWY_INLINE void transpose([[maybe_unused]] V& x, [[maybe_unused]] V& y, [[maybe_unused]] V& z, [[maybe_unused]] V& w) {
#if HWY_TARGET != HWY_SCALAR  // where a vector is one number already
  const Float d;
  const hn::Repartition<std::uint64_t, Float> pairs;
  const auto xyLow = hn::BitCast(pairs, hn::InterleaveLower(d, x, y));
  const auto xyHigh = hn::BitCast(pairs, hn::InterleaveUpper(d, x, y));
  const auto zwLow = hn::BitCast(pairs, hn::InterleaveLower(d, z, w));
  const auto zwHigh = hn::BitCast(pairs, hn::InterleaveUpper(d, z, w));
  x = hn::BitCast(d, hn::InterleaveLower(pairs, xyLow, zwLow));
  y = hn::BitCast(d, hn::InterleaveUpper(pairs, xyLow, zwLow));
  z = hn::BitCast(d, hn::InterleaveLower(pairs, xyHigh, zwHigh));
  w = hn::BitCast(d, hn::InterleaveUpper(pairs, xyHigh, zwHigh));
#endif
}

/// Pixels' places on a face: its coordinates halved (-0.5 ... 0.5), and the cells of the finest grid they lie in.
struct Places {
  V x;
  V y;
  I column;
  I row;
  V length;  ///< largest |p|
};

/// @param px, py, length  of pixels divided by `largest`
HWY_INLINE Places placesOn(V px, V py, V length, V largest, int rootBits) {
  const Float d;
  const Int di;
  const V halfReciprocal = hn::Div(hn::Set(d, 0.5F), hn::Max(length, hn::Set(d, kSmallest)));
  const int cellBits = rootBits + Map::kMaximumDepth;
  // 1.5 more than a coordinate lies within [1, 2): the top bits of its mantissa are the cell.
  const auto cell = [&](V coordinate) {
    const V within = hn::Min(hn::Max(hn::Add(coordinate, hn::Set(d, 1.5F)), hn::Set(d, 1.0F)), hn::Set(d, kBelowTwo));
    return hn::And(hn::ShiftRightSame(hn::BitCast(di, within), kMantissaBits - cellBits),
                   hn::Set(di, (1 << cellBits) - 1));
  };
  const V x = hn::Mul(px, halfReciprocal);
  const V y = hn::Mul(py, halfReciprocal);
  return {x, y, cell(x), cell(y), hn::Mul(length, largest)};
}

constexpr int kDepthMask = (1 << Map::kDepthBits) - 1;
constexpr int kInRoot = (1 << Map::kMaximumDepth) - 1;

/// Indices of the patches of the front face that pixels lie on.
HWY_INLINE I patchesOn(const Map& map, const Places& places) {
  const Int di;
  constexpr int kRootBits = Map::kRootBits[Map::kFrontFace];
  const I cell = hn::Add(hn::ShiftLeft<kRootBits>(hn::ShiftRight<Map::kMaximumDepth>(places.row)),
                         hn::ShiftRight<Map::kMaximumDepth>(places.column));
  const auto* const roots = reinterpret_cast<const std::int32_t*>(map.roots.data()) + map.faceOffset[Map::kFrontFace];
  const I root = hn::GatherIndex(di, roots, cell);
  const I depth = hn::And(root, hn::Set(di, kDepthMask));
  const I coarser = hn::Sub(hn::Set(di, Map::kMaximumDepth), depth);
  const auto within = [&](I cells) { return hn::Shr(hn::And(cells, hn::Set(di, kInRoot)), coarser); };
  const I entry = hn::Add(hn::ShiftRight<Map::kDepthBits>(root),
                          hn::Add(hn::Shl(within(places.row), depth), within(places.column)));
  return hn::GatherIndex(di, reinterpret_cast<const std::int32_t*>(map.patchIndex.data()), entry);
}

/// The patch of one cell of any face.
inline const Map::Patch& patchOf(const Map& map, std::size_t face, std::int32_t column, std::int32_t row) {
  const auto cell =
      static_cast<std::uint32_t>((row >> Map::kMaximumDepth << Map::kRootBits[face]) + (column >> Map::kMaximumDepth));
  const std::uint32_t root = map.roots[map.faceOffset[face] + cell];
  const std::uint32_t depth = root & kDepthMask;
  const std::uint32_t coarser = Map::kMaximumDepth - depth;
  const auto within = [&](std::int32_t at) { return static_cast<std::uint32_t>(at & kInRoot) >> coarser; };
  return map.patches[map.patchIndex[(root >> Map::kDepthBits) + (within(row) << depth) + within(column)]];
}

struct Colours {
  V red;
  V green;
  V blue;
};

/// Values of a patch times the pixels' lengths, where the mask says so.
HWY_INLINE void applyPatch(const Map::Patch& patch, const Places& places, Mask mask, Colours& result) {
  const Float d;
  const V scale = hn::Set(d, patch.scale);
  const V u = fused(places.x, scale, hn::Set(d, patch.offset[0]));
  const V v = fused(places.y, scale, hn::Set(d, patch.offset[1]));
  const auto channel = [&](std::size_t k) {
    const auto term = [&](std::size_t i) { return hn::Set(d, patch.coefficients[3 * i + k]); };
    const V constant = fused(fused(fused(term(3), u, term(2)), u, term(1)), u, term(0));
    const V linear = fused(fused(fused(term(7), u, term(6)), u, term(5)), u, term(4));
    const V square = fused(term(9), u, term(8));
    const V cube = fused(term(11), u, term(10));
    return hn::Mul(fused(fused(fused(cube, v, square), v, linear), v, constant), places.length);
  };
  result.red = hn::IfThenElse(mask, channel(0), result.red);
  result.green = hn::IfThenElse(mask, channel(1), result.green);
  result.blue = hn::IfThenElse(mask, channel(2), result.blue);
}

/// Colours beyond the front face are rare (strong negatives): one lane at a time.
HWY_NOINLINE void applyFar(const Map& map, V px, V py, V pz, V largest, Mask far, Colours& result) {
  const Float d;
  HWY_ALIGN std::array<std::array<float, kMostLanes>, 3> lanes;
  hn::Store(px, d, lanes[0].data());
  hn::Store(py, d, lanes[1].data());
  hn::Store(pz, d, lanes[2].data());
  for (std::intptr_t lane = hn::FindFirstTrue(d, far); lane >= 0; lane = hn::FindFirstTrue(d, far)) {
    const auto at = static_cast<std::size_t>(lane);
    const std::array<float, 3> p = {lanes[0][at], lanes[1][at], lanes[2][at]};
    std::size_t axis = 2;
    for (std::size_t k = 0; k < 2; ++k) {
      axis = std::abs(p[k]) > std::abs(p[axis]) ? k : axis;
    }
    const std::size_t face = 2 * axis + (p[axis] > 0.0F ? 0 : 1);
    const Places places = placesOn(hn::Set(d, p[(axis + 1) % 3]), hn::Set(d, p[(axis + 2) % 3]),
                                   hn::Set(d, std::abs(p[axis])), largest, Map::kRootBits[face]);
    const Mask own = hn::RebindMask(d, hn::Eq(hn::Iota(Int(), 0), hn::Set(Int(), static_cast<std::int32_t>(lane))));
    applyPatch(patchOf(map, face, hn::GetLane(places.column), hn::GetLane(places.row)), places, own, result);
    far = hn::AndNot(own, far);
  }
}

/// A vector of pixels of which some are still to be looked up.
struct Pending {
  Places places;
  I patches;  ///< their patches
  Mask todo;  ///< those
  Colours result;
  V alpha;
  float* destination;
};

HWY_INLINE void store(Colours colours, V alpha, float* destination) {
  const Float d;
  const std::size_t lanes = hn::Lanes(d);
  transpose(colours.red, colours.green, colours.blue, alpha);
  hn::StoreU(colours.red, d, destination);
  hn::StoreU(colours.green, d, destination + lanes);
  hn::StoreU(colours.blue, d, destination + 2 * lanes);
  hn::StoreU(alpha, d, destination + 3 * lanes);
}

/// Begins a vector of pixels: stores it, or leaves it pending and returns true.
HWY_INLINE bool begin(const Map& map, const float* source, float* destination, Pending& pending) {
  const Float d;
  const std::size_t lanes = hn::Lanes(d);
  V r = hn::LoadU(d, source);
  V g = hn::LoadU(d, source + lanes);
  V b = hn::LoadU(d, source + 2 * lanes);
  V a = hn::LoadU(d, source + 3 * lanes);
  transpose(r, g, b, a);
  const V zero = hn::Zero(d);
  // x * 0 is 0 for finite x only.
  const Mask finite = hn::Eq(hn::Add(hn::Add(hn::Mul(r, zero), hn::Mul(g, zero)), hn::Mul(b, zero)), zero);
  V inside = map.linearNormalCount == 0 ? hn::Set(d, -1.0F) : zero;
  const float* normal = map.linearNormals.data();
  for (int k = 0; k < map.linearNormalCount; ++k, normal += 3) {
    inside = hn::Min(inside, dot(normal, r, g, b));
  }
  const Mask linear = hn::And(finite, hn::Ge(inside, zero));
  // What is not finite stays as it is.
  const float* matrix = map.linearMatrix.data();
  Colours result{hn::IfThenElse(linear, dot(matrix, r, g, b), r), hn::IfThenElse(linear, dot(matrix + 3, r, g, b), g),
                 hn::IfThenElse(linear, dot(matrix + 6, r, g, b), b)};
  const Mask rest = hn::AndNot(linear, finite);
  if (hn::AllFalse(d, rest)) {
    store(result, a, destination);
    return false;
  }
  // Quotients, rounded once, are the same at every exposure to the last bit, and so is all that follows from them: else
  // a steep transform would show the rounding of the place.
  const V largest = hn::Max(hn::Max(hn::Abs(r), hn::Abs(g)), hn::Max(hn::Abs(b), hn::Set(d, kSmallest)));
  r = hn::Div(r, largest);
  g = hn::Div(g, largest);
  b = hn::Div(b, largest);
  const float* cube = map.cubeFromRgb.data();
  const V px = dot(cube, r, g, b);
  const V py = dot(cube + 3, r, g, b);
  const V pz = dot(cube + 6, r, g, b);
  const Mask front = hn::Ge(pz, hn::Max(hn::Abs(px), hn::Abs(py)));
  const Mask far = hn::AndNot(front, rest);
  if (HWY_UNLIKELY(!hn::AllFalse(d, far))) {
    applyFar(map, px, py, pz, largest, far, result);
  }
  const Places places = placesOn(px, py, pz, largest, Map::kRootBits[Map::kFrontFace]);
  pending = {places, patchesOn(map, places), hn::And(rest, front), result, a, destination};
  return true;
}

/// Evaluates the patches that are left and stores the vector.
HWY_INLINE void finish(const Map& map, const Pending& pending) {
  const Float d;
  const Int di;
  HWY_ALIGN std::array<std::int32_t, kMostLanes> patches;
  hn::Store(pending.patches, di, patches.data());
  Colours result = pending.result;
  Mask todo = pending.todo;
  for (std::intptr_t lane = hn::FindFirstTrue(d, todo); lane >= 0; lane = hn::FindFirstTrue(d, todo)) {
    const std::int32_t patch = patches[static_cast<std::size_t>(lane)];
    const Mask same = hn::RebindMask(d, hn::Eq(pending.patches, hn::Set(di, patch)));
    applyPatch(map.patches[static_cast<std::size_t>(patch)], pending.places, hn::And(todo, same), result);
    todo = hn::AndNot(same, todo);
  }
  store(result, pending.alpha, pending.destination);
}

/// Brings the pixels from `pixel` on, a vector of them, near: the processor does not see that far by itself.
HWY_INLINE void prefetch(const float* source, const float* destination, std::size_t pixel, std::size_t pixelCount) {
  constexpr std::size_t kFloatsPerLine = 16;
  const std::size_t end = std::min(4 * (pixel + hn::Lanes(Float())), 4 * pixelCount);
  for (std::size_t i = 4 * pixel; i < end; i += kFloatsPerLine) {
    hwy::Prefetch(source + i);
    hwy::Prefetch(destination + i);
  }
}

void applyMap(const Map& map, const float* source, float* destination, std::size_t pixelCount) {
  const std::size_t lanes = hn::Lanes(Float());
  // A vector's way through the table is longer than a processor looks ahead: two take each half of it side by side.
  constexpr std::size_t kTogether = 2;
  std::array<Pending, kTogether> pending;
  std::size_t pixel = 0;
  while (pixel + lanes <= pixelCount) {
    std::size_t count = 0;
    for (std::size_t k = 0; k < kTogether && pixel + lanes <= pixelCount; ++k, pixel += lanes) {
      prefetch(source, destination, pixel + kPrefetchedPixels, pixelCount);
      count += begin(map, source + 4 * pixel, destination + 4 * pixel, pending[count]) ? 1 : 0;
    }
    for (std::size_t k = 0; k < count; ++k) {
      finish(map, pending[k]);
    }
  }
  if (pixel < pixelCount) {
    std::array<float, 4 * kMostLanes> padded{};
    std::copy(source + 4 * pixel, source + 4 * pixelCount, padded.begin());
    if (begin(map, padded.data(), padded.data(), pending[0])) {
      finish(map, pending[0]);
    }
    std::copy_n(padded.begin(), 4 * (pixelCount - pixel), destination + 4 * pixel);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace metamer::sip
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer::sip {

namespace {

using ApplyMap = void(const HomogeneousMap&, const float*, float*, std::size_t);

}  // namespace

void HomogeneousMap::apply(std::span<const float> source, std::span<float> destination) const {
  assert(source.size() == destination.size() && source.size() % 4 == 0);
  if (identity) {
    if (source.data() != destination.data()) {
      std::copy(source.begin(), source.end(), destination.begin());
    }
    return;
  }
  METAMER_CHOOSE_KERNEL(ApplyMap, applyMap)(*this, source.data(), destination.data(), source.size() / 4);
}

}  // namespace metamer::sip
#endif
