// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace metamer::spectral_ref {

/// Of bytes in pieces, all but the last a whole number of words: a checkpoint or a part's sums may be a gigabyte. Finds
/// what went wrong on the way, not who meant it.
class CheckSum {
 public:
  static constexpr std::size_t kWord = sizeof(std::uint64_t);

  void add(const void* bytes, std::size_t size) {
    const auto* from = static_cast<const unsigned char*>(bytes);
    std::size_t i = 0;
    for (; i + kWord <= size; i += kWord) {
      std::uint64_t word = 0;
      std::memcpy(&word, from + i, kWord);
      mix(word);
    }
    for (; i < size; ++i) {
      mix(from[i] + std::uint64_t{0x100});  // no run of zeros is like another
    }
  }
  std::uint64_t value() const { return m_mixed; }

 private:
  void mix(std::uint64_t word) {
    m_mixed = (m_mixed ^ word) * 0x9e3779b97f4a7c15U;
    m_mixed ^= m_mixed >> 32U;
  }

  std::uint64_t m_mixed = 0x243f6a8885a308d3U;
};

}  // namespace metamer::spectral_ref
