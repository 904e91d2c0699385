// SPDX-License-Identifier: Apache-2.0
#include "lights/alias_table.h"

#include <numeric>

namespace metamer::spectral_ref {

AliasTable::AliasTable(const std::vector<double>& weights) {
  const std::size_t count = weights.size();
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  std::vector<double> scaled(count, 1.0);
  m_entries.resize(count);
  std::vector<std::uint32_t> small;
  std::vector<std::uint32_t> large;
  for (std::size_t i = 0; i < count; ++i) {
    if (total > 0) {
      scaled[i] = weights[i] / total * static_cast<double>(count);
    }
    m_entries[i] = {0xffffffffU, static_cast<std::uint32_t>(i),
                    static_cast<float>(scaled[i] / static_cast<double>(count))};
    (scaled[i] < 1.0 ? small : large).push_back(static_cast<std::uint32_t>(i));
  }
  while (!small.empty() && !large.empty()) {
    const std::uint32_t low = small.back();
    const std::uint32_t high = large.back();
    small.pop_back();
    constexpr double kTwo32 = 4294967296.0;
    // "rest <= threshold" has threshold + 1 of the 2^32 chances; an entry of no weight must have none.
    const double chances = scaled[low] * kTwo32;
    m_entries[low].alias = high;
    m_entries[low].threshold = chances < 1.0 ? 0U : static_cast<std::uint32_t>(chances - 1.0);
    scaled[high] -= 1.0 - scaled[low];
    if (scaled[high] < 1.0) {
      large.pop_back();
      small.push_back(high);
    }
  }
}

}  // namespace metamer::spectral_ref
