// SPDX-License-Identifier: Apache-2.0
#include "integrator/sampler.h"

#include <cassert>
#include <cstddef>
#include <cstring>

#include "metamer/spectral/vector_lanes.h"

namespace metamer::spectral_ref {
namespace {

// Dimensions that are worked on at once: the functions below take one number or so many.
#ifdef __GNUC__
using Several = std::uint32_t __attribute__((vector_size(Sampler::kSetSize * sizeof(std::uint32_t))));
#else
using Several = std::uint32_t;
#endif
constexpr std::size_t kParts = Sampler::kSetSize * sizeof(std::uint32_t) / sizeof(Several);

/// Parts of numbers, which may lie anywhere in memory. (By reference: vectors as results have another ABI for each
/// instruction set.)
METAMER_ALWAYS_INLINE void take(const std::uint32_t* numbers, std::size_t part, Several& several) {
  std::memcpy(&several, numbers + part * (sizeof(Several) / sizeof(std::uint32_t)), sizeof several);
}
METAMER_ALWAYS_INLINE void put(const Several& several, std::uint32_t* numbers, std::size_t part) {
  std::memcpy(numbers + part * (sizeof(Several) / sizeof(std::uint32_t)), &several, sizeof several);
}

template <typename Bits>
METAMER_ALWAYS_INLINE constexpr void reverseInBytes(Bits& x) {
  x = ((x >> 1U) & 0x55555555U) | ((x & 0x55555555U) << 1U);
  x = ((x >> 2U) & 0x33333333U) | ((x & 0x33333333U) << 2U);
  x = ((x >> 4U) & 0x0f0f0f0fU) | ((x & 0x0f0f0f0fU) << 4U);
}
template <typename Bits>
METAMER_ALWAYS_INLINE constexpr void reverse(Bits& x) {
  reverseInBytes(x);
  x = ((x >> 8U) & 0x00ff00ffU) | ((x & 0x00ff00ffU) << 8U);
  x = (x >> 16U) | (x << 16U);
}
#ifdef __GNUC__
/// With the bytes put in place at once.
template <>
METAMER_ALWAYS_INLINE void reverse(Several& x) {
  using Bytes = std::uint8_t __attribute__((vector_size(sizeof(Several))));
  reverseInBytes(x);
  const auto bytes = reinterpret_cast<Bytes>(x);  // NOLINT
  x = reinterpret_cast<Several>(                  // NOLINT
      __builtin_shufflevector(bytes, bytes, 3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12, 19, 18, 17, 16, 23,
                              22, 21, 20, 27, 26, 25, 24, 31, 30, 29, 28));
}
#endif
constexpr std::uint32_t reversed(std::uint32_t x) {
  reverse(x);
  return x;
}

/// Owen scrambling of a bit-reversed number: each bit is flipped by a hash of those below it (Laine and Karras 2011,
/// with the constants of Vegdahl 2021).
template <typename Bits>
METAMER_ALWAYS_INLINE constexpr void scrambleReversed(Bits& x, const Bits& seed) {
  x ^= x * 0x3d20adeaU;
  x += seed;
  x *= (seed >> 16U) | 1U;
  x ^= x * 0x05526c56U;
  x ^= x * 0x53a22864U;
}
/// Its reverse, scrambled.
template <typename Bits>
METAMER_ALWAYS_INLINE constexpr void scramble(Bits& x, const Bits& seed) {
  scrambleReversed(x, seed);
  reverse(x);
}

/// Primitive polynomial and first direction numbers of a Sobol dimension (Joe and Kuo 2008, new-joe-kuo-6).
struct Polynomial {
  unsigned degree;
  unsigned coefficients;
  std::array<std::uint32_t, 5> first;
};
constexpr std::array<Polynomial, Sampler::kSetSize - 1> kPolynomials = {{{1, 0, {1}},
                                                                         {2, 1, {1, 3}},
                                                                         {3, 1, {1, 3, 1}},
                                                                         {3, 2, {1, 1, 1}},
                                                                         {4, 1, {1, 1, 3, 3}},
                                                                         {4, 4, {1, 3, 5, 13}},
                                                                         {5, 2, {1, 1, 5, 5, 17}}}};

constexpr unsigned kBits = 32;
using Directions = std::array<std::array<std::uint32_t, Sampler::kSetSize>, kBits>;

/// [bit of the index][dimension], bit-reversed so that the scrambling needs no reversal.
constexpr Directions makeDirections() {
  Directions directions{};
  for (unsigned bit = 0; bit < kBits; ++bit) {
    directions[bit][0] = 1U << bit;
  }
  for (std::size_t d = 1; d < Sampler::kSetSize; ++d) {
    const Polynomial& polynomial = kPolynomials[d - 1];
    std::array<std::uint32_t, kBits> v{};
    for (unsigned bit = 0; bit < kBits; ++bit) {
      if (bit < polynomial.degree) {
        v[bit] = polynomial.first[bit] << (kBits - 1 - bit);
        continue;
      }
      v[bit] = v[bit - polynomial.degree] ^ (v[bit - polynomial.degree] >> polynomial.degree);
      for (unsigned k = 1; k < polynomial.degree; ++k) {
        if (((polynomial.coefficients >> (polynomial.degree - 1 - k)) & 1U) != 0) {
          v[bit] ^= v[bit - k];
        }
      }
    }
    for (unsigned bit = 0; bit < kBits; ++bit) {
      directions[bit][d] = reversed(v[bit]);
    }
  }
  return directions;
}
constexpr Directions kDirections = makeDirections();

/// [digit of the index, the lowest first][its value][dimension]: points are sums over digits, four bits at a time.
constexpr unsigned kDigitBits = 4;
constexpr unsigned kDigitValues = 1U << kDigitBits;
using Digits = std::array<std::array<std::array<std::uint32_t, Sampler::kSetSize>, kDigitValues>, kBits / kDigitBits>;

constexpr Digits makeDigits() {
  Digits digits{};
  for (unsigned digit = 0; digit < kBits / kDigitBits; ++digit) {
    for (unsigned value = 0; value < kDigitValues; ++value) {
      for (unsigned bit = 0; bit < kDigitBits; ++bit) {
        for (std::size_t d = 0; d < Sampler::kSetSize && ((value >> bit) & 1U) != 0; ++d) {
          digits[digit][value][d] ^= kDirections[digit * kDigitBits + bit][d];
        }
      }
    }
  }
  return digits;
}
alignas(32) constexpr Digits kDigits = makeDigits();

constexpr std::uint32_t kApart = 0x9e3779b9U;  // between the seeds' counters

std::uint32_t dimensionSeed(std::uint32_t seed, std::size_t dimension) {
  return hash32(seed + static_cast<std::uint32_t>(dimension) * kApart);
}

constexpr std::array<std::uint32_t, Sampler::kSetSize> kCounters = {0,           kApart,      2U * kApart, 3U * kApart,
                                                                    4U * kApart, 5U * kApart, 6U * kApart, 7U * kApart};

constexpr unsigned kShuffledBits = 16;

/// The sets are padded: an Owen-shuffled index breaks the correlation between them and keeps the stratification.
/// Only within blocks of 2^16 points: a permutation still, and an index of few bits stays one.
template <typename Bits>
METAMER_ALWAYS_INLINE void shuffle(Bits& index, const Bits& seed) {
  constexpr std::uint32_t kBlock = (1U << kShuffledBits) - 1U;
  Bits bits = index;
  reverse(bits);
  scramble(bits, seed);
  index = (bits & kBlock) | (index & ~kBlock);
}

/// dimensionSeed of all dimensions, for several sets. Whole numbers: they are the same in lanes of any width.
METAMER_VECTOR_LANES void makeSeeds(Sampler::Seeds* const* sets, std::size_t count) {
  for (std::size_t n = 0; n < count; ++n) {
    for (std::size_t i = 0; i < kParts; ++i) {
      Several bits;
      take(kCounters.data(), i, bits);
      bits += sets[n]->index;
      mix32(bits);
      put(bits, sets[n]->dimensions.data(), i);
    }
  }
}

/// All dimensions of several points: while one waits for a product, the next is begun.
METAMER_VECTOR_LANES void makePoints(const Sampler::Order* orders, std::size_t count) {
  static_assert(Sampler::kMostTogether % Sampler::kSetSize == 0);
  alignas(Several) std::array<std::uint32_t, Sampler::kMostTogether> indices{};
  alignas(Several) std::array<std::uint32_t, Sampler::kMostTogether> shuffles{};
  for (std::size_t n = 0; n < count; ++n) {
    indices[n] = orders[n].index;
    shuffles[n] = orders[n].seeds->index;
  }
  constexpr std::size_t kIndexParts = Sampler::kMostTogether * sizeof(std::uint32_t) / sizeof(Several);
  for (std::size_t i = 0; i < kIndexParts; ++i) {
    Several several;
    Several seeds;
    take(indices.data(), i, several);
    take(shuffles.data(), i, seeds);
    shuffle<Several>(several, seeds);
    put(several, indices.data(), i);
  }
  for (std::size_t n = 0; n < count; ++n) {
    const Sampler::Seeds& seeds = *orders[n].seeds;
    std::array<Several, kParts> bits{};
    std::uint32_t index = indices[n];
    const auto add = [&](std::size_t digit, std::uint32_t value) {
      for (std::size_t i = 0; i < kParts; ++i) {
        Several digits;
        take(kDigits[digit][value % kDigitValues].data(), i, digits);
        bits[i] ^= digits;
      }
    };
    // Those of the shuffled bits without asking which are zero.
    for (std::size_t digit = 0; digit < kShuffledBits / kDigitBits; ++digit) {
      add(digit, index >> (digit * kDigitBits));
    }
    index >>= kShuffledBits;
    for (std::size_t digit = kShuffledBits / kDigitBits; index != 0; ++digit, index >>= kDigitBits) {
      add(digit, index);
    }
    for (std::size_t i = 0; i < kParts; ++i) {
      Several seed;
      take(seeds.dimensions.data(), i, seed);
      scramble(bits[i], seed);
      put(bits[i], orders[n].set->bits.data(), i);
    }
  }
}

}  // namespace

Sampler::Candidates Sampler::candidates(std::uint32_t number, unsigned log2Count) const {
  const std::uint32_t seed = hash32(m_sequence, number);
  Candidates result{};
  std::uint32_t index = m_index;
  shuffle(index, seed);
  for (unsigned bit = log2Count; index != 0 && bit < kBits; ++bit, index >>= 1U) {
    const std::uint32_t mask = 0U - (index & 1U);
    for (std::size_t d = 0; d < result.m_bits.size(); ++d) {
      result.m_bits[d] ^= kDirections[bit][d] & mask;
    }
  }
  for (std::size_t d = 0; d < result.m_seeds.size(); ++d) {
    result.m_seeds[d] = dimensionSeed(seed, d);
  }
  return result;
}

std::array<std::uint32_t, 3> Sampler::Candidates::point(std::uint32_t candidate) const {
  std::array<std::uint32_t, 3> bits = m_bits;
  for (unsigned bit = 0; bit < kLog2Most; ++bit) {
    const std::uint32_t mask = 0U - ((candidate >> bit) & 1U);
    for (std::size_t d = 0; d < bits.size(); ++d) {
      bits[d] ^= kDirections[bit][d] & mask;
    }
  }
  for (std::size_t d = 0; d < bits.size(); ++d) {
    scramble(bits[d], m_seeds[d]);
  }
  return bits;
}

Sampler::Seeds::Seeds(std::uint32_t sequence, std::uint32_t number) : index(hash32(sequence, number)) {
  Seeds* own = this;
  makeSeeds(&own, 1);
}

Sampler::Set Sampler::set(const Seeds& seeds) const {
  Set result;
  const Order order{m_index, &seeds, &result};
  makePoints(&order, 1);
  return result;
}

void Sampler::fill(std::span<const Order> orders) {
  assert(orders.size() <= kMostTogether);
  makePoints(orders.data(), orders.size());
}

void Sampler::fill(std::span<const Sampler* const> samplers, std::uint32_t number, std::span<Set* const> sets) {
  assert(samplers.size() <= kMostTogether && sets.size() == samplers.size());
  std::array<std::uint32_t, kMostTogether> sequences{};
  std::array<Seeds, kMostTogether> seeds;
  std::array<Order, kMostTogether> orders{};
  for (std::size_t i = 0; i < samplers.size(); ++i) {
    sequences[i] = samplers[i]->m_sequence;
    orders[i] = {samplers[i]->m_index, &seeds[i], sets[i]};
  }
  seed({sequences.data(), samplers.size()}, number, {seeds.data(), samplers.size()});
  makePoints(orders.data(), samplers.size());
}

void Sampler::seed(std::span<const std::uint32_t> sequences, std::uint32_t number, std::span<Seeds> seeds) {
  assert(sequences.size() <= kMostTogether && seeds.size() == sequences.size());
  std::array<Seeds*, kMostTogether> unmade{};
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    seeds[i].index = hash32(sequences[i], number);
    unmade[i] = &seeds[i];
  }
  makeSeeds(unmade.data(), seeds.size());
}

}  // namespace metamer::spectral_ref
