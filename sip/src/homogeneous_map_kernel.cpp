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
#include <cassert>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace metamer::sip {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Map = HomogeneousMap;

constexpr std::size_t kMostLanes = 16;
using Float = hn::CappedTag<float, kMostLanes>;
using V = hn::VFromD<Float>;

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

/// Scalar look-up, for any face.
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
    return {map.patches.data(), 0.0F, 0.0F, 0.0F};
  }
  const std::size_t face = 2 * axis + (p[axis] > 0.0F ? 0 : 1);
  const int side = Map::kRootsPerSide[face];
  const int cells = side << Map::kMaximumDepth;
  const auto scaled = [&](std::size_t k) {
    return (p[k % 3] / length * 0.5F + 0.5F) * static_cast<float>(cells);
  };
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
  return {&map.patches[static_cast<std::size_t>(entry >> Map::kDepthBits) * Map::kPatchFloats], length,
          (u - static_cast<float>((cellU >> span) << span)) * reciprocal,
          (v - static_cast<float>((cellV >> span) << span)) * reciprocal};
}

/// Value of a patch times the pixel's length: red, green, blue.
HWY_INLINE void applyPatch(const Place& place, float* result) {
  // Sixteen lanes: the four powers of u, each red, green, blue, 0. Horner in v; the powers of u are summed last.
  const hn::CappedTag<float, 16> d;
  HWY_ALIGN std::array<float, 16> powersOfU;
  HWY_ALIGN std::array<float, 16> terms;
  const float u2 = place.u * place.u;
  std::fill_n(powersOfU.begin(), 4, 1.0F);
  std::fill_n(powersOfU.begin() + 4, 4, place.u);
  std::fill_n(powersOfU.begin() + 8, 4, u2);
  std::fill_n(powersOfU.begin() + 12, 4, u2 * place.u);
  const auto v = hn::Set(d, place.v);
  for (std::size_t i = 0; i < 16; i += hn::Lanes(d)) {
    auto sum = hn::LoadU(d, place.patch + 48 + i);
    sum = hn::Add(hn::Mul(sum, v), hn::LoadU(d, place.patch + 32 + i));
    sum = hn::Add(hn::Mul(sum, v), hn::LoadU(d, place.patch + 16 + i));
    sum = hn::Add(hn::Mul(sum, v), hn::LoadU(d, place.patch + i));
    hn::Store(hn::Mul(sum, hn::Load(d, powersOfU.data() + i)), d, terms.data() + i);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    result[k] = ((terms[k] + terms[k + 4]) + (terms[k + 8] + terms[k + 12])) * place.length;
  }
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
    linear = hn::And(linear, hn::Ge(dot(hn::Set(d, normal[0]), hn::Set(d, normal[1]), hn::Set(d, normal[2]), r, g, b),
                                    zero));
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
  HWY_ALIGN std::array<float, kMostLanes> reds;
  HWY_ALIGN std::array<float, kMostLanes> greens;
  HWY_ALIGN std::array<float, kMostLanes> blues;
  HWY_ALIGN std::array<std::uint8_t, (kMostLanes + 7) / 8 + 8> bits{};
  hn::Store(r, d, reds.data());
  hn::Store(g, d, greens.data());
  hn::Store(b, d, blues.data());
  hn::StoreMaskBits(d, rest, bits.data());
  for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
    if ((bits[lane / 8] >> (lane % 8) & 1U) != 0U) {
      const std::array<float, 3> rgb = {reds[lane], greens[lane], blues[lane]};
      applyPatch(locate(map, rgb.data()), destination + 4 * lane);
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
