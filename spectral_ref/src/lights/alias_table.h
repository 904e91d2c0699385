// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace metamer::spectral_ref {

/// Draws an index in proportion to given weights, in constant time (Walker 1977, built by Vose 1991).
class AliasTable {
 public:
  AliasTable() = default;
  /// @param weights  not negative, finite; all zero: every index is as likely
  explicit AliasTable(const std::vector<double>& weights);

  bool empty() const { return m_entries.empty(); }
  std::size_t size() const { return m_entries.size(); }
  /// @param bits  32 random bits: enough for millions of entries, as a float's 24 are not
  std::uint32_t sample(std::uint32_t bits) const {
    const std::uint64_t product = std::uint64_t{bits} * m_entries.size();
    const auto index = static_cast<std::uint32_t>(product >> 32U);
    const auto rest = static_cast<std::uint32_t>(product);
    const Entry& entry = m_entries[index];
    return rest <= entry.threshold ? index : entry.alias;
  }
  float probability(std::uint32_t index) const { return m_entries[index].probability; }

 private:
  struct Entry {
    std::uint32_t threshold;  ///< of the 32 bits below the index; all ones: always this one
    std::uint32_t alias;
    float probability;
  };
  std::vector<Entry> m_entries;
};

}  // namespace metamer::spectral_ref
