// SPDX-License-Identifier: Apache-2.0
// The map's pixel kernel, compiled once an instruction set by Highway and chosen at run time.
//
// Every result is the same sequence of float32 operations whatever the instruction set and whichever pixels lie beside
// it, so neighbours, tails and machines cannot change it.
//
// A pixel takes the one matrix where that is exact, else its place in the fine table, else its patch: which of them,
// its own colour alone decides.
#include "metamer/sip/homogeneous_map.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "map/homogeneous_map_kernel.cpp"
#include <hwy/foreach_target.h>
// Highway needs the target list first.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "map/patch_lanes-inl.h"
#include "metamer/spectral/argument_checks.h"
#include "vector/choose_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::sip {
namespace HWY_NAMESPACE {

/// How far ahead memory is asked for: 4 KiB.
constexpr std::size_t kPrefetchedPixels = 256;

/// Pixels that go through the fine table together: first all their places, then all their values. A processor runs
/// ahead of the one and of the other, but not through a choice that waits for both.
constexpr std::size_t kBlockPixels = 64;

/// Some vectors of pixels on their way through the fine table, a channel each.
struct Block {
  template <typename T>
  using Plane = std::array<T, kBlockPixels>;
  HWY_ALIGN std::array<Plane<float>, 3> place;  ///< on the front face: x, y, length
  HWY_ALIGN Plane<float> lowRow;                ///< weight of the two nodes below a pixel, times its length
  HWY_ALIGN Plane<float> highRow;               ///< of the two above
  HWY_ALIGN Plane<float> right;                 ///< how far from the left two to the right two: 0 ... 1
  HWY_ALIGN Plane<std::int32_t> node;           ///< of the first, in floats
  HWY_ALIGN Plane<std::int32_t> isHere;         ///< of a mixed vector; 0: not of the table's, but as in `elsewhere`
  HWY_ALIGN std::array<float, 4 * kBlockPixels> elsewhere;  ///< whole pixels
  std::array<std::uint16_t, kBlockPixels> pixel;            ///< of a vector: its first, within the block
  std::array<bool, kBlockPixels> isMixed;                   ///< of a vector: some are elsewhere
};

/// Where a vector's pixel lies in its planes (transpose).
template <std::size_t kLanes>
constexpr std::size_t laneOf(std::size_t pixel) {
  constexpr std::size_t kQuarter = std::max<std::size_t>(1, kLanes / 4);
  return kLanes < 4 ? pixel : 4 * (pixel % kQuarter) + pixel / kQuarter;
}

struct Pixels {
  Colours colours;
  V alpha;
};

HWY_INLINE Pixels loadPixels(const float* source) {
  const Float d;
  const std::size_t lanes = hn::Lanes(d);
  Pixels pixels{{hn::LoadU(d, source), hn::LoadU(d, source + lanes), hn::LoadU(d, source + 2 * lanes)},
                hn::LoadU(d, source + 3 * lanes)};
  transpose(pixels.colours.red, pixels.colours.green, pixels.colours.blue, pixels.alpha);
  return pixels;
}

HWY_INLINE void store(Colours colours, V alpha, float* destination) {
  const Float d;
  const std::size_t lanes = hn::Lanes(d);
  transpose(colours.red, colours.green, colours.blue, alpha);
  hn::StoreU(colours.red, d, destination);
  hn::StoreU(colours.green, d, destination + lanes);
  hn::StoreU(colours.blue, d, destination + 2 * lanes);
  hn::StoreU(alpha, d, destination + 3 * lanes);
}

/// Begins a vector of pixels: stores it, or writes its places to the block and returns true.
HWY_INLINE bool begin(const Map& map, const float* source, float* destination, std::size_t at, Block& block) {
  const Float d;
  const Int di;
  const std::size_t lanes = hn::Lanes(d);
  const auto [colours, a] = loadPixels(source);
  const auto [r, g, b] = colours;
  Mask linear = hn::FirstN(d, 0);
  if (map.linearNormalCount > 0) {
    linear = inLinearCone(map, r, g, b);
    if (hn::AllTrue(d, linear)) {
      store(throughMatrix(map, r, g, b), a, destination);
      return false;
    }
  }
  const Planes pixels = planesOf(map, r, g, b);
  const Mask here = hn::AndNot(linear, onFront(pixels));
  const bool isMixed = !hn::AllTrue(d, here);
  if (HWY_UNLIKELY(isMixed)) {
    const Colours product = throughMatrix(map, r, g, b);
    // What is not finite stays as it is.
    Colours result{hn::IfThenElse(linear, product.red, r), hn::IfThenElse(linear, product.green, g),
                   hn::IfThenElse(linear, product.blue, b)};
    const Mask far = hn::AndNot(linear, hn::AndNot(here, isFinite(r, g, b)));
    if (HWY_UNLIKELY(!hn::AllFalse(d, far))) {
      applyFar(map, pixels, far, result);
    }
    if (hn::AllFalse(d, here)) {
      store(result, a, destination);
      return false;
    }
    store(result, a, block.elsewhere.data() + 4 * at);
    hn::Store(hn::IfThenElseZero(hn::RebindMask(di, here), hn::Set(di, 1)), di, block.isHere.data() + at);
  }
  block.isMixed[at / lanes] = isMixed;
  const Places places = placesOn(pixels.px, pixels.py, pixels.pz, pixels.largest);
  hn::Store(places.x, d, block.place[0].data() + at);
  hn::Store(places.y, d, block.place[1].data() + at);
  hn::Store(places.length, d, block.place[2].data() + at);
  const I column = cellsAt(places.x, Map::kFineBits);
  const I row = cellsAt(places.y, Map::kFineBits);
  // Within its cell: what is left of the coordinate, rounded once.
  const auto within = [&](V coordinate, I cell) {
    const V before = hn::Sub(hn::Set(d, 0.5F * static_cast<float>(Map::kFineSide)), hn::ConvertTo(d, cell));
    return fused(coordinate, hn::Set(d, static_cast<float>(Map::kFineSide)), before);
  };
  const V u = within(places.x, column);
  const V v = within(places.y, row);
  const V high = hn::Mul(v, places.length);
  hn::Store(hn::Sub(places.length, high), d, block.lowRow.data() + at);
  hn::Store(high, d, block.highRow.data() + at);
  hn::Store(u, d, block.right.data() + at);
  const I node = hn::Add(hn::Mul(row, hn::Set(di, Map::kFineSide + 1)), column);
  hn::Store(hn::ShiftLeft<2>(node), di, block.node.data() + at);
  return true;
}

#if HWY_TARGET != HWY_SCALAR
using Four = hn::FixedTag<float, 4>;
using Pixel = hn::VFromD<Four>;
HWY_INLINE Pixel load(const float* pixel) {
  return hn::LoadU(Four(), pixel);
}
HWY_INLINE Pixel set(float value) {
  return hn::Set(Four(), value);
}
HWY_INLINE void storeColour(Pixel colour, Pixel alpha, float* pixel) {
  const Four d;
  hn::StoreU(hn::IfThenElse(hn::FirstN(d, 3), colour, alpha), d, pixel);
}
HWY_INLINE Pixel product(Pixel a, Pixel b) {
  return hn::Mul(a, b);
}
HWY_INLINE Pixel difference(Pixel a, Pixel b) {
  return hn::Sub(a, b);
}
HWY_INLINE Pixel either(Pixel a, Pixel b) {
  return hn::Or(a, b);
}
HWY_INLINE float alphaOf(Pixel pixel) {
  HWY_ALIGN std::array<float, 4> four;
  hn::Store(pixel, Four(), four.data());
  return four[3];
}
#else
using Pixel = std::array<float, 4>;
inline Pixel load(const float* pixel) {
  return {pixel[0], pixel[1], pixel[2], pixel[3]};
}
inline Pixel set(float value) {
  return {value, value, value, value};
}
inline void storeColour(const Pixel& colour, const Pixel& alpha, float* pixel) {
  std::copy_n(colour.begin(), 3, pixel);
  pixel[3] = alpha[3];
}
inline Pixel product(const Pixel& a, const Pixel& b) {
  return {a[0] * b[0], a[1] * b[1], a[2] * b[2], a[3] * b[3]};
}
inline Pixel difference(const Pixel& a, const Pixel& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]};
}
inline Pixel fused(const Pixel& a, const Pixel& b, const Pixel& c) {
  return {std::fma(a[0], b[0], c[0]), std::fma(a[1], b[1], c[1]), std::fma(a[2], b[2], c[2]),
          std::fma(a[3], b[3], c[3])};
}
/// Of which the alpha alone is looked at.
inline Pixel either(const Pixel& a, const Pixel& b) {
  return {0.0F, 0.0F, 0.0F, std::max(a[3], b[3])};
}
inline float alphaOf(const Pixel& pixel) {
  return pixel[3];
}
#endif

/// Two nodes side by side, and a row of them mixed with the next.
#if HWY_MAX_BYTES >= 32
using Eight = hn::FixedTag<float, 8>;
using Two = hn::VFromD<Eight>;
HWY_INLINE Two loadTwo(const float* nodes) {
  return hn::LoadU(Eight(), nodes);
}
HWY_INLINE Two mixed(Two low, float lowWeight, Two high, float highWeight) {
  const Eight d;
  return fused(high, hn::Set(d, highWeight), hn::Mul(low, hn::Set(d, lowWeight)));
}
HWY_INLINE Pixel leftOf(Two nodes) {
  return hn::LowerHalf(Four(), nodes);
}
HWY_INLINE Pixel rightOf(Two nodes) {
  return hn::UpperHalf(Four(), nodes);
}
#else
struct Two {
  Pixel left;
  Pixel right;
};
HWY_INLINE Two loadTwo(const float* nodes) {
  return {load(nodes), load(nodes + 4)};
}
HWY_INLINE Two mixed(const Two& low, float lowWeight, const Two& high, float highWeight) {
  const Pixel a = set(lowWeight);
  const Pixel b = set(highWeight);
  return {fused(high.left, b, product(low.left, a)), fused(high.right, b, product(low.right, a))};
}
HWY_INLINE Pixel leftOf(const Two& nodes) {
  return nodes.left;
}
HWY_INLINE Pixel rightOf(const Two& nodes) {
  return nodes.right;
}
#endif

/// Looks a vector's pixels up in the fine table and stores them. Returns whether that held for all.
template <bool kMixed, std::size_t... kPixels>
HWY_INLINE bool finishFine(const Map& map, const Block& block, std::size_t at, const float* source, float* destination,
                           std::index_sequence<kPixels...> /*pixels*/) {
  constexpr std::size_t kRow = 4 * (std::size_t{Map::kFineSide} + 1);
  const float* const fine = map.fine.data();
  Pixel first = set(0.0F);
  const auto finishOne = [&](std::size_t pixel, std::size_t place) {
    const Pixel given = load(source + 4 * pixel);
    if (kMixed && block.isHere[place] == 0) {
      storeColour(load(block.elsewhere.data() + 4 * (at + pixel)), given, destination + 4 * pixel);
      return;
    }
    const float* const node = fine + block.node[place];
    const Two low = loadTwo(node);
    const Two both = mixed(low, block.lowRow[place], loadTwo(node + kRow), block.highRow[place]);
    const Pixel left = leftOf(both);
    const Pixel value = fused(set(block.right[place]), difference(rightOf(both), left), left);
    first = either(first, leftOf(low));
    storeColour(value, given, destination + 4 * pixel);
  };
  (finishOne(kPixels, at + laneOf<sizeof...(kPixels)>(kPixels)), ...);
  return alphaOf(first) == 0.0F;
}

/// Where the fine table does not hold, a vector's pixels by their patches.
HWY_NOINLINE void finishExactly(const Map& map, const Block& block, std::size_t at, float* destination) {
  const Float d;
  const Int di;
  const V coarse = hn::GatherIndex(d, map.fine.data() + 3, hn::Load(di, block.node.data() + at));
  Mask wanted = hn::Ne(coarse, hn::Zero(d));
  if (block.isMixed[at / hn::Lanes(d)]) {
    wanted = hn::And(wanted, hn::RebindMask(d, hn::Ne(hn::Load(di, block.isHere.data() + at), hn::Zero(di))));
  }
  const Places places{hn::Load(d, block.place[0].data() + at), hn::Load(d, block.place[1].data() + at),
                      hn::Load(d, block.place[2].data() + at)};
  auto [colours, alpha] = loadPixels(destination);
  applyPatches(map, places, wanted, colours);
  store(colours, alpha, destination);
}

HWY_INLINE void finish(const Map& map, const Block& block, std::size_t at, const float* source, float* destination) {
  constexpr std::make_index_sequence<hn::MaxLanes(Float())> kPixels;
  const bool held = HWY_UNLIKELY(block.isMixed[at / hn::Lanes(Float())])
                        ? finishFine<true>(map, block, at, source, destination, kPixels)
                        : finishFine<false>(map, block, at, source, destination, kPixels);
  if (HWY_UNLIKELY(!held)) {
    finishExactly(map, block, at, destination);
  }
}

/// Brings a vector of pixels near, from `pixel` on: the processor does not see that far by itself.
HWY_INLINE void prefetch(const float* pixels, std::size_t pixel, std::size_t pixelCount) {
  constexpr std::size_t kFloatsPerLine = 16;
  constexpr std::size_t kLanes = hn::MaxLanes(Float());
  if (pixel + kLanes <= pixelCount) {
    for (std::size_t i = 0; i < 4 * kLanes; i += kFloatsPerLine) {
      hwy::Prefetch(pixels + 4 * pixel + i);
    }
  }
}

void applyMap(const Map& map, const float* source, float* destination, std::size_t pixelCount) {
  const std::size_t lanes = hn::Lanes(Float());
  Block block;
  std::size_t pixel = 0;
  while (pixel + lanes <= pixelCount) {
    const std::size_t first = pixel;
    const std::size_t end = std::min(pixelCount, pixel + kBlockPixels);
    std::size_t count = 0;
    for (; pixel + lanes <= end; pixel += lanes) {
      prefetch(source, pixel + kPrefetchedPixels, pixelCount);
      block.pixel[count] = static_cast<std::uint16_t>(pixel - first);
      if (begin(map, source + 4 * pixel, destination + 4 * pixel, count * lanes, block)) {
        ++count;
      } else {  // stored: no finish() asks for what follows
        prefetch(destination, pixel + kPrefetchedPixels, pixelCount);
      }
    }
    for (std::size_t k = 0; k < count; ++k) {
      prefetch(destination, first + block.pixel[k] + kPrefetchedPixels, pixelCount);
      const std::size_t at = 4 * (first + block.pixel[k]);
      finish(map, block, k * lanes, source + at, destination + at);
    }
  }
  if (pixel < pixelCount) {
    std::array<float, 4 * kMostLanes> padded{};
    std::copy(source + 4 * pixel, source + 4 * pixelCount, padded.begin());
    if (begin(map, padded.data(), padded.data(), 0, block)) {
      finish(map, block, 0, padded.data(), padded.data());
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
  spectral::requirePixels(static_cast<std::int64_t>(source.size()));
  spectral::requireAsMany("destination", static_cast<std::int64_t>(destination.size()), "the source",
                          static_cast<std::int64_t>(source.size()));
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
