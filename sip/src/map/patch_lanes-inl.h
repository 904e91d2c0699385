// SPDX-License-Identifier: Apache-2.0
// A vector of pixels on the map's patches. Compiled once an instruction set, inside the file that includes it.
#if defined(METAMER_SIP_PATCH_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef METAMER_SIP_PATCH_LANES_INL_H
#undef METAMER_SIP_PATCH_LANES_INL_H
#else
#define METAMER_SIP_PATCH_LANES_INL_H
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "map/fused_in_double.h"
#include "metamer/sip/homogeneous_map.h"

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

#if !HWY_NATIVE_FMA && HWY_TARGET != HWY_WASM
/// fused(), for processors of before 2013. A call each time: their kernels would be larger than all others together.
template <typename Vector>
HWY_NOINLINE Vector fusedByLanes(Vector a, Vector b, Vector c) {
  const hn::DFromV<Vector> d;
  HWY_ALIGN std::array<float, kMostLanes> x;
  HWY_ALIGN std::array<float, kMostLanes> y;
  HWY_ALIGN std::array<float, kMostLanes> z;
  HWY_ALIGN std::array<float, kMostLanes> result;
  hn::Store(a, d, x.data());
  hn::Store(b, d, y.data());
  hn::Store(c, d, z.data());
  bool isRoundedOnce = true;
  for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
    result[lane] = fusedInDouble(x[lane], y[lane], z[lane], isRoundedOnce);
  }
  if (HWY_UNLIKELY(!isRoundedOnce)) {
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
      result[lane] = std::fma(x[lane], y[lane], z[lane]);
    }
  }
  return hn::Load(d, result.data());
}
#endif

/// a * b + c, rounded once.
template <typename Vector>
HWY_INLINE Vector fused(Vector a, Vector b, Vector c) {
#if HWY_NATIVE_FMA
  return hn::MulAdd(a, b, c);
#elif HWY_TARGET == HWY_WASM
  // As fusedInDouble(), but unchecked: off by at most one unit in the last place, once in 2^28 times.
  const auto half = [](v128_t x, v128_t y, v128_t z) {
    return wasm_f32x4_demote_f64x2_zero(
        wasm_f64x2_add(wasm_f64x2_mul(wasm_f64x2_promote_low_f32x4(x), wasm_f64x2_promote_low_f32x4(y)),
                       wasm_f64x2_promote_low_f32x4(z)));
  };
  const auto high = [](v128_t x) { return wasm_i32x4_shuffle(x, x, 2, 3, 2, 3); };
  const v128_t low = half(a.raw, b.raw, c.raw);
  return Vector{wasm_i32x4_shuffle(low, half(high(a.raw), high(b.raw), high(c.raw)), 0, 1, 4, 5)};
#else
  return fusedByLanes(a, b, c);
#endif
}

/// c - a * b, rounded once.
HWY_INLINE V fusedRest(V a, V b, V c) {
#if HWY_NATIVE_FMA
  return hn::NegMulAdd(a, b, c);
#else
  return fused(hn::Neg(a), b, c);
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

/// A vector of pixels, a channel each.
struct Planes {
  V r;
  V g;
  V b;
  V largest;  ///< |channel|
  V px;       ///< cube coordinates over it
  V py;
  V pz;
};

/// Quotients, rounded once, are the same at every exposure to the last bit, and so is all that follows from them: else
/// a steep transform, and the seams of its table, would show the rounding of the place.
HWY_INLINE Planes planesOf(const Map& map, V r, V g, V b) {
  const Float d;
  const V largest = hn::Max(hn::Max(hn::Abs(r), hn::Abs(g)), hn::Max(hn::Abs(b), hn::Set(d, kSmallest)));
  const V reciprocal = hn::Div(hn::Set(d, 1.0F), largest);
  // Division by a reciprocal that is rounded once (Markstein 1990): what the first product misses is known exactly.
  const auto over = [&](V channel) {
    const V near = hn::Mul(channel, reciprocal);
    return fused(fusedRest(near, largest, channel), reciprocal, near);
  };
  const V x = over(r);
  const V y = over(g);
  const V z = over(b);
  const float* cube = map.cubeFromRgb.data();
  return {r, g, b, largest, dot(cube, x, y, z), dot(cube + 3, x, y, z), dot(cube + 6, x, y, z)};
}

/// Pixels' places on a face: its coordinates halved, -0.5 ... 0.5.
struct Places {
  V x;
  V y;
  V length;  ///< largest |p|
};

/// @param px, py, length  of pixels divided by `largest`
HWY_INLINE Places placesOn(V px, V py, V length, V largest) {
  const Float d;
  const V halfReciprocal = hn::Div(hn::Set(d, 0.5F), hn::Max(length, hn::Set(d, kSmallest)));
  return {hn::Mul(px, halfReciprocal), hn::Mul(py, halfReciprocal), hn::Mul(length, largest)};
}

/// The cells coordinates lie in, of 2^bits a side.
HWY_INLINE I cellsAt(V coordinate, int bits) {
  const Float d;
  const Int di;
  // 1.5 more than a coordinate lies within [1, 2): the top bits of its mantissa are the cell.
  const V within = hn::Min(hn::Max(hn::Add(coordinate, hn::Set(d, 1.5F)), hn::Set(d, 1.0F)), hn::Set(d, kBelowTwo));
  return hn::And(hn::ShiftRightSame(hn::BitCast(di, within), kMantissaBits - bits), hn::Set(di, (1 << bits) - 1));
}

constexpr int kDepthMask = (1 << Map::kDepthBits) - 1;
constexpr int kInRoot = (1 << Map::kMaximumDepth) - 1;

/// Indices of the patches of the front face that pixels lie on.
HWY_INLINE I patchesOn(const Map& map, const Places& places) {
  const Int di;
  constexpr int kRootBits = Map::kRootBits[Map::kFrontFace];
  const I column = cellsAt(places.x, kRootBits + Map::kMaximumDepth);
  const I row = cellsAt(places.y, kRootBits + Map::kMaximumDepth);
  const I cell = hn::Add(hn::ShiftLeft<kRootBits>(hn::ShiftRight<Map::kMaximumDepth>(row)),
                         hn::ShiftRight<Map::kMaximumDepth>(column));
  const auto* const roots = reinterpret_cast<const std::int32_t*>(map.roots.data()) + map.faceOffset[Map::kFrontFace];
  const I root = hn::GatherIndex(di, roots, cell);
  const I depth = hn::And(root, hn::Set(di, kDepthMask));
  const I coarser = hn::Sub(hn::Set(di, Map::kMaximumDepth), depth);
  const auto within = [&](I cells) { return hn::Shr(hn::And(cells, hn::Set(di, kInRoot)), coarser); };
  const I entry = hn::Add(hn::ShiftRight<Map::kDepthBits>(root), hn::Add(hn::Shl(within(row), depth), within(column)));
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
inline HWY_NOINLINE void applyFar(const Map& map, const Planes& pixels, Mask far, Colours& result) {
  const Float d;
  HWY_ALIGN std::array<std::array<float, kMostLanes>, 3> lanes;
  hn::Store(pixels.px, d, lanes[0].data());
  hn::Store(pixels.py, d, lanes[1].data());
  hn::Store(pixels.pz, d, lanes[2].data());
  for (std::intptr_t lane = hn::FindFirstTrue(d, far); lane >= 0; lane = hn::FindFirstTrue(d, far)) {
    const auto at = static_cast<std::size_t>(lane);
    const std::array<float, 3> p = {lanes[0][at], lanes[1][at], lanes[2][at]};
    std::size_t axis = 2;
    for (std::size_t k = 0; k < 2; ++k) {
      axis = std::abs(p[k]) > std::abs(p[axis]) ? k : axis;
    }
    const std::size_t face = 2 * axis + (p[axis] > 0.0F ? 0 : 1);
    const Places places = placesOn(hn::Set(d, p[(axis + 1) % 3]), hn::Set(d, p[(axis + 2) % 3]),
                                   hn::Set(d, std::abs(p[axis])), pixels.largest);
    const auto cell = [&](V coordinate) {
      return hn::GetLane(cellsAt(coordinate, Map::kRootBits[face] + Map::kMaximumDepth));
    };
    const Mask own = hn::RebindMask(d, hn::Eq(hn::Iota(Int(), 0), hn::Set(Int(), static_cast<std::int32_t>(lane))));
    applyPatch(patchOf(map, face, cell(places.x), cell(places.y)), places, own, result);
    far = hn::AndNot(own, far);
  }
}

HWY_INLINE Mask isFinite(V r, V g, V b) {
  const V zero = hn::Zero(Float());
  // x * 0 is 0 for finite x only.
  return hn::Eq(fused(b, zero, fused(g, zero, hn::Mul(r, zero))), zero);
}

/// Those on the front face; none that is not finite, as its coordinates are not numbers.
HWY_INLINE Mask onFront(const Planes& pixels) {
  return hn::Ge(pixels.pz, hn::Max(hn::Abs(pixels.px), hn::Abs(pixels.py)));
}

HWY_INLINE Mask inLinearCone(const Map& map, V r, V g, V b) {
  const V zero = hn::Zero(Float());
  V inside = zero;
  const float* normal = map.linearNormals.data();
  for (int k = 0; k < map.linearNormalCount; ++k, normal += 3) {
    inside = hn::Min(inside, dot(normal, r, g, b));
  }
  return hn::And(isFinite(r, g, b), hn::Ge(inside, zero));
}

HWY_INLINE Colours throughMatrix(const Map& map, V r, V g, V b) {
  const float* matrix = map.linearMatrix.data();
  return {dot(matrix, r, g, b), dot(matrix + 3, r, g, b), dot(matrix + 6, r, g, b)};
}

/// Those pixels of the front face that are wanted, by the patches they lie on. As neighbours mostly share a patch, that
/// of the first pixel left is evaluated for all that lie on it, its coefficients the same for every lane, until none is
/// left.
HWY_INLINE void applyPatches(const Map& map, const Places& places, Mask wanted, Colours& result) {
  const Float d;
  const Int di;
  const I patches = patchesOn(map, places);
  HWY_ALIGN std::array<std::int32_t, kMostLanes> each;
  hn::Store(patches, di, each.data());
  for (std::intptr_t lane = hn::FindFirstTrue(d, wanted); lane >= 0; lane = hn::FindFirstTrue(d, wanted)) {
    const std::int32_t patch = each[static_cast<std::size_t>(lane)];
    const Mask same = hn::And(wanted, hn::RebindMask(d, hn::Eq(patches, hn::Set(di, patch))));
    applyPatch(map.patches[static_cast<std::size_t>(patch)], places, same, result);
    wanted = hn::AndNot(same, wanted);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace metamer::sip
HWY_AFTER_NAMESPACE();

#endif
