// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "metamer/spectral/vector_lanes.h"

namespace metamer::spectral_ref {

/// Mixes the bits of a number, or of several in vector lanes (a finaliser of the murmur family, by Wellons).
template <typename Bits>
METAMER_ALWAYS_INLINE void mix32(Bits& x) {
  x ^= x >> 16U;
  x *= 0x21f0aaadU;
  x ^= x >> 15U;
  x *= 0xd35a2d97U;
  x ^= x >> 15U;
}
/// Well mixed 32 bits of a counter or a pair of them.
inline std::uint32_t hash32(std::uint32_t x) {
  mix32(x);
  return x;
}
inline std::uint32_t hash32(std::uint32_t a, std::uint32_t b) {
  return hash32(a ^ (hash32(b + 0x9e3779b9U) * 0x85ebca6bU + 0xc2b2ae35U));
}

/// 0 ... 1, never 1, from 32 bits.
inline float unitFloat(std::uint32_t bits) {
  return static_cast<float>(bits >> 8U) * 0x1p-24F;
}

/// Random numbers of one path: Owen-scrambled Sobol points in sets of eight dimensions, each set a shuffled sequence of
/// its own (Burley 2020, Practical Hash-based Owen Scrambling). A pure function of seed, pixel, sample and set.
class Sampler {
 public:
  static constexpr int kSetSize = 8;
  struct Set {
    std::array<std::uint32_t, kSetSize> bits;
    float operator[](std::size_t dimension) const { return unitFloat(bits[dimension]); }
  };

  Sampler() = default;
  /// @param sequence  names the pixel and the replicate: points of one sequence are stratified against each other
  /// @param index     of the sample within the sequence
  Sampler(std::uint32_t sequence, std::uint32_t index) : m_sequence(sequence), m_index(index) {}

  /// What all points of a set have in common, whatever their index.
  struct Seeds {
    std::uint32_t index;  ///< of the shuffle
    std::array<std::uint32_t, kSetSize> dimensions;
    Seeds() = default;
    Seeds(std::uint32_t sequence, std::uint32_t number);
  };
  /// A set to be worked out together with others, which takes less time.
  struct Order {
    std::uint32_t index;
    const Seeds* seeds;
    Set* set;
  };
  static constexpr std::size_t kMostTogether = 16;
  /// The seeds of a set of several sequences. @param seeds  of each; at most kMostTogether
  static void seed(std::span<const std::uint32_t> sequences, std::uint32_t number, std::span<Seeds> seeds);
  /// @param orders  at most kMostTogether
  static void fill(std::span<const Order> orders);
  /// The same set of several samplers. @param sets  of each; at most kMostTogether
  static void fill(std::span<const Sampler* const> samplers, std::uint32_t number, std::span<Set* const> sets);

  Set set(std::uint32_t number) const { return set(Seeds(m_sequence, number)); }
  /// The same with seeds that have been worked out once for all points.
  Set set(const Seeds& seeds) const;

  /// Points of three dimensions for several candidates a path: those of one path are stratified against each other, and
  /// all of a sequence's are.
  class Candidates {
   public:
    static constexpr unsigned kLog2Most = 4;
    std::array<std::uint32_t, 3> point(std::uint32_t candidate) const;

   private:
    friend class Sampler;
    std::array<std::uint32_t, 3> m_bits;
    std::array<std::uint32_t, 3> m_seeds;
  };
  /// @param log2Count  of the candidates a path, at most kLog2Most
  Candidates candidates(std::uint32_t number, unsigned log2Count) const;

  /// Not stratified: for choices that come up too rarely.
  float random(std::uint32_t number) const {
    return unitFloat(hash32(hash32(m_sequence, m_index), number ^ 0x5bd1e995U));
  }

 private:
  std::uint32_t m_sequence = 0;
  std::uint32_t m_index = 0;
};

}  // namespace metamer::spectral_ref
