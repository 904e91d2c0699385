// SPDX-License-Identifier: Apache-2.0
// The map's pixel kernel, compiled once per instruction set and chosen at run time (Highway).
//
// Every result is the same sequence of separate float32 multiplications and additions whatever the instruction set
// and whichever branch a pixel took, so neighbours, tails and machines cannot change it.
#include "metamer/sip/homogeneous_map.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/homogeneous_map_kernel.cpp"
#include <hwy/foreach_target.h>
// Highway's dispatch needs the target list first.
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

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

constexpr int kFrontRoots = Map::kRootsPerSide[Map::kFrontFace];
constexpr int kFrontRootBits = std::countr_zero(static_cast<unsigned>(kFrontRoots));
static_assert(1 << kFrontRootBits == kFrontRoots);
/// Keeps the reciprocal of a denormal finite: such a pixel's place is off, by less than it is bright.
constexpr float kLargest = std::numeric_limits<float>::max();
constexpr int kFrontCells = kFrontRoots << Map::kMaximumDepth;

HWY_INLINE V dot(V ax, V ay, V az, V x, V y, V z) {
  return hn::Add(hn::Add(hn::Mul(ax, x), hn::Mul(ay, y)), hn::Mul(az, z));
}

/// A pixel's place in the table.
struct Place {
  const float* patch;
  float length;  ///< largest |p|
  float u;       ///< 0 ... 1 over the patch
  float v;
};

/// Scalar look-up, for any face: colours beyond the front one are rare (strong negatives).
inline Place locate(const Map& map, const float* rgb) {
  std::array<float, 3> p{};
  for (std::size_t k = 0; k < 3; ++k) {
    const float* row = &map.cubeFromRgb[3 * k];
    p[k] = row[0] * rgb[0] + row[1] * rgb[1] + row[2] * rgb[2];
  }
  std::size_t axis = 2;
  for (std::size_t k = 0; k < 2; ++k) {
    if (std::abs(p[k]) > std::abs(p[axis])) {
      axis = k;
    }
  }
  const float length = std::abs(p[axis]);
  if (!(length > 0.0F)) {
    return {map.patches.front().coefficients.data(), 0.0F, 0.0F, 0.0F};
  }
  const std::size_t face = 2 * axis + (p[axis] > 0.0F ? 0 : 1);
  const int side = Map::kRootsPerSide[face];
  const int cells = side << Map::kMaximumDepth;
  const float halfReciprocal = std::min(0.5F / length, kLargest);
  const auto scaled = [&](std::size_t k) { return (p[k % 3] * halfReciprocal + 0.5F) * static_cast<float>(cells); };
  const float u = scaled(axis + 1);
  const float v = scaled(axis + 2);
  const int cellU = std::clamp(static_cast<int>(u), 0, cells - 1);
  const int cellV = std::clamp(static_cast<int>(v), 0, cells - 1);
  const std::uint32_t root =
      map.roots[map.faceOffset[face] +
                static_cast<std::uint32_t>((cellV >> Map::kMaximumDepth) * side + (cellU >> Map::kMaximumDepth))];
  constexpr std::uint32_t kDepthMask = (1U << Map::kDepthBits) - 1U;
  const auto depth = static_cast<int>(root & kDepthMask);
  const int shift = Map::kMaximumDepth - depth;
  const int mask = (1 << Map::kMaximumDepth) - 1;
  const std::uint32_t entry =
      map.patchIndex[(root >> Map::kDepthBits) +
                     static_cast<std::uint32_t>((((cellV & mask) >> shift) << depth) + ((cellU & mask) >> shift))];
  // The patch spans 2^span finest cells and starts at a multiple of that.
  const int span = Map::kMaximumDepth - static_cast<int>(entry & kDepthMask);
  const float reciprocal = 1.0F / static_cast<float>(1 << span);
  return {map.patches[entry >> Map::kDepthBits].coefficients.data(), length,
          (u - static_cast<float>((cellU >> span) << span)) * reciprocal,
          (v - static_cast<float>((cellV >> span) << span)) * reciprocal};
}

/// Value of a patch times the pixel's length, and the alpha given: four floats at `destination`.
/// Horner in v, then (i0 + u^2 i2) + u (i1 + u^2 i3) over the powers of u, whatever the vector length.
HWY_INLINE void applyPatch(const float* patch, float length, float u, float v, float alpha, float* destination) {
  const float u2 = u * u;
#if HWY_TARGET <= HWY_AVX3 && HWY_TARGET != HWY_SCALAR
  const hn::FixedTag<float, 16> d;
  const auto vs = hn::Set(d, v);
  auto powers = hn::Load(d, patch + 48);
  powers = hn::Add(hn::Mul(powers, vs), hn::Load(d, patch + 32));
  powers = hn::Add(hn::Mul(powers, vs), hn::Load(d, patch + 16));
  powers = hn::Add(hn::Mul(powers, vs), hn::Load(d, patch));
  const hn::FixedTag<float, 8> d8;
  const auto pair = hn::Add(hn::LowerHalf(d8, powers), hn::Mul(hn::UpperHalf(d8, powers), hn::Set(d8, u2)));
  const hn::FixedTag<float, 4> d4;
  const auto sum = hn::Add(hn::LowerHalf(d4, pair), hn::Mul(hn::UpperHalf(d4, pair), hn::Set(d4, u)));
  hn::StoreU(hn::Mul(sum, hn::Set(d4, length)), d4, destination);
#else
  const hn::CappedTag<float, 4> d;
  const auto vs = hn::Set(d, v);
  for (std::size_t k = 0; k < 4; k += hn::Lanes(d)) {
    const auto power = [&](std::size_t i) {
      auto value = hn::Load(d, patch + 48 + 4 * i + k);
      value = hn::Add(hn::Mul(value, vs), hn::Load(d, patch + 32 + 4 * i + k));
      value = hn::Add(hn::Mul(value, vs), hn::Load(d, patch + 16 + 4 * i + k));
      return hn::Add(hn::Mul(value, vs), hn::Load(d, patch + 4 * i + k));
    };
    const auto even = hn::Add(power(0), hn::Mul(power(2), hn::Set(d, u2)));
    const auto odd = hn::Add(power(1), hn::Mul(power(3), hn::Set(d, u2)));
    const auto sum = hn::Add(even, hn::Mul(odd, hn::Set(d, u)));
    hn::StoreU(hn::Mul(sum, hn::Set(d, length)), d, destination + k);
  }
#endif
  destination[3] = alpha;
}

/// Places of one vector of pixels on the front face; `beyond` are those that lie on another.
struct Places {
  HWY_ALIGN std::array<std::int32_t, kMostLanes> patch;  ///< index
  HWY_ALIGN std::array<float, kMostLanes> length;
  HWY_ALIGN std::array<float, kMostLanes> u;
  HWY_ALIGN std::array<float, kMostLanes> v;
};

/// The same arithmetic as locate(), a vector at a time.
HWY_INLINE hn::Mask<Float> locateOnFront(const Map& map, V r, V g, V b, Places& places) {
  const Float d;
  const Int di;
  const auto row = [&](std::size_t k) {
    return dot(hn::Set(d, map.cubeFromRgb[3 * k]), hn::Set(d, map.cubeFromRgb[3 * k + 1]),
               hn::Set(d, map.cubeFromRgb[3 * k + 2]), r, g, b);
  };
  const V px = row(0);
  const V py = row(1);
  const V pz = row(2);
  const auto front = hn::And(hn::And(hn::Ge(pz, hn::Abs(px)), hn::Ge(pz, hn::Abs(py))), hn::Gt(pz, hn::Zero(d)));
  const V length = hn::IfThenElse(front, pz, hn::Set(d, 1.0F));
  const V half = hn::Set(d, 0.5F);
  const V halfReciprocal = hn::Min(hn::Div(half, length), hn::Set(d, kLargest));
  const auto scaled = [&](V p) {
    const V coordinate = hn::Mul(hn::IfThenElseZero(front, p), halfReciprocal);
    return hn::Mul(hn::Add(coordinate, half), hn::Set(d, static_cast<float>(kFrontCells)));
  };
  const auto cell = [&](V x) {
    return hn::Min(hn::Max(hn::ConvertTo(di, x), hn::Zero(di)), hn::Set(di, kFrontCells - 1));
  };
  const V u = scaled(px);
  const V v = scaled(py);
  const I cellU = cell(u);
  const I cellV = cell(v);
  const I rootIndex = hn::Add(hn::ShiftLeft<kFrontRootBits>(hn::ShiftRight<Map::kMaximumDepth>(cellV)),
                              hn::ShiftRight<Map::kMaximumDepth>(cellU));
  const auto* roots = reinterpret_cast<const std::int32_t*>(map.roots.data() + map.faceOffset[Map::kFrontFace]);
  const I root = hn::GatherIndex(di, roots, rootIndex);
  const I depthMask = hn::Set(di, (1 << Map::kDepthBits) - 1);
  const I depth = hn::And(root, depthMask);
  const I deepest = hn::Set(di, Map::kMaximumDepth);
  const I shift = hn::Sub(deepest, depth);
  const I mask = hn::Set(di, (1 << Map::kMaximumDepth) - 1);
  const I index =
      hn::Add(hn::ShiftRight<Map::kDepthBits>(root),
              hn::Add(hn::Shl(hn::Shr(hn::And(cellV, mask), shift), depth), hn::Shr(hn::And(cellU, mask), shift)));
  const I entry = hn::GatherIndex(di, reinterpret_cast<const std::int32_t*>(map.patchIndex.data()), index);
  const I span = hn::Sub(deepest, hn::And(entry, depthMask));
  // 2^-span by its exponent bits.
  const V reciprocal = hn::BitCast(d, hn::ShiftLeft<23>(hn::Sub(hn::Set(di, 127), span)));
  const auto local = [&](V x, I c) {
    return hn::Mul(hn::Sub(x, hn::ConvertTo(d, hn::Shl(hn::Shr(c, span), span))), reciprocal);
  };
  hn::Store(hn::ShiftRight<Map::kDepthBits>(entry), di, places.patch.data());
  hn::Store(length, d, places.length.data());
  hn::Store(local(u, cellU), d, places.u.data());
  hn::Store(local(v, cellV), d, places.v.data());
  return hn::Not(front);
}

/// One vector of pixels.
HWY_INLINE void applyVector(const Map& map, const float* source, float* destination) {
  const Float d;
  V r;
  V g;
  V b;
  V a;
  hn::LoadInterleaved4(d, source, r, g, b, a);
  // x * 0 is 0 for finite x only.
  const V zero = hn::Zero(d);
  const auto finite = hn::Eq(hn::Add(hn::Add(hn::Mul(r, zero), hn::Mul(g, zero)), hn::Mul(b, zero)), zero);
  auto linear = map.linearNormalCount == 0 ? hn::Lt(zero, zero) : finite;
  const float* normal = map.linearNormals.data();
  for (int k = 0; k < map.linearNormalCount; ++k, normal += 3) {
    linear = hn::And(linear,
                     hn::Ge(dot(hn::Set(d, normal[0]), hn::Set(d, normal[1]), hn::Set(d, normal[2]), r, g, b), zero));
  }
  const float* m = map.linearMatrix.data();
  const auto row = [&](int k) {
    return dot(hn::Set(d, m[3 * k]), hn::Set(d, m[3 * k + 1]), hn::Set(d, m[3 * k + 2]), r, g, b);
  };
  // What is not finite stays as it is.
  hn::StoreInterleaved4(hn::IfThenElse(linear, row(0), r), hn::IfThenElse(linear, row(1), g),
                        hn::IfThenElse(linear, row(2), b), a, d, destination);
  const auto rest = hn::AndNot(linear, finite);
  if (hn::AllFalse(d, rest)) {
    return;
  }
  Places places;
  const auto beyond =
      locateOnFront(map, hn::IfThenElseZero(rest, r), hn::IfThenElseZero(rest, g), hn::IfThenElseZero(rest, b), places);
  HWY_ALIGN std::array<float, kMostLanes> alphas;
  hn::Store(a, d, alphas.data());
  HWY_ALIGN std::array<std::uint8_t, 8> restBits{};
  HWY_ALIGN std::array<std::uint8_t, 8> beyondBits{};
  hn::StoreMaskBits(d, rest, restBits.data());
  hn::StoreMaskBits(d, hn::And(rest, beyond), beyondBits.data());
  unsigned todo = restBits[0] | static_cast<unsigned>(restBits[1]) << 8U;
  const unsigned far = beyondBits[0] | static_cast<unsigned>(beyondBits[1]) << 8U;
  for (; todo != 0; todo &= todo - 1U) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(todo));
    float* pixel = destination + 4 * lane;
    if ((far >> lane & 1U) == 0U) {
      const auto patch = static_cast<std::size_t>(places.patch[lane]);
      applyPatch(map.patches[patch].coefficients.data(), places.length[lane], places.u[lane], places.v[lane],
                 alphas[lane], pixel);
    } else {
      const std::array<float, 3> rgb = {pixel[0], pixel[1], pixel[2]};  // still the source's
      const Place place = locate(map, rgb.data());
      applyPatch(place.patch, place.length, place.u, place.v, alphas[lane], pixel);
    }
  }
}

void applyMap(const Map& map, const float* source, float* destination, std::size_t pixelCount) {
  const Float d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t pixel = 0;
  for (; pixel + lanes <= pixelCount; pixel += lanes) {
    applyVector(map, source + 4 * pixel, destination + 4 * pixel);
  }
  if (pixel < pixelCount) {
    std::array<float, 4 * kMostLanes> padded{};
    std::copy(source + 4 * pixel, source + 4 * pixelCount, padded.begin());
    applyVector(map, padded.data(), padded.data());
    std::copy_n(padded.begin(), 4 * (pixelCount - pixel), destination + 4 * pixel);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace metamer::sip
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer::sip {

HWY_EXPORT(applyMap);

void HomogeneousMap::apply(std::span<const float> source, std::span<float> destination) const {
  assert(source.size() == destination.size() && source.size() % 4 == 0);
  if (identity) {
    if (source.data() != destination.data()) {
      std::copy(source.begin(), source.end(), destination.begin());
    }
    return;
  }
  HWY_DYNAMIC_DISPATCH(applyMap)(*this, source.data(), destination.data(), source.size() / 4);
}

}  // namespace metamer::sip
#endif
