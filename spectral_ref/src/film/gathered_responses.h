// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "metamer/spectral/vector_lanes.h"
#include "metamer/spectral_ref/film.h"

namespace metamer::spectral_ref {

/// Responses that a pixel's paths give, on their way into a film: whole numbers of its unit, as the film's own sums, so
/// that going this way changes no bit. Four numbers at once, and none of them twice.
class GatheredResponses {
 public:
  /// That one takes, lest a sum outgrow its 64 bits.
  static constexpr std::uint64_t kMostPaths = 4096;

  /// @param unitsInOne  of the film's sums
  explicit GatheredResponses(double unitsInOne)
      : m_unitsInOne(unitsInOne),
        m_mostSquared(static_cast<float>(kMostUnits / unitsInOne * (kMostUnits / unitsInOne))) {}

  /// Adds three responses and luminance to a replicate.
  /// @return  false, and nothing added, where they are too large, or no numbers
  METAMER_ALWAYS_INLINE bool add(std::size_t replicate, const Eigen::Array4f& response) {
    if (!(response.square().sum() < m_mostSquared)) {
      return false;
    }
    std::array<std::int64_t, 4>& sums = m_sums[replicate];
    for (std::size_t c = 0; c < sums.size(); ++c) {
      // Where doubles are whole numbers, the last bits are the nearest whole number: as std::llrint, in vector lanes.
      const double units = static_cast<double>(response[static_cast<Eigen::Index>(c)]) * m_unitsInOne;
      sums[c] += std::bit_cast<std::int64_t>(units + kWhole) - std::bit_cast<std::int64_t>(kWhole);
    }
    return true;
  }

  /// Adds all to a pixel of the film.
  void addTo(FilmSums& film, std::size_t pixel) const;

 private:
  static constexpr double kWhole = 0x1.8p52;
  static constexpr double kMostUnits = 0x1p50;
  static_assert(static_cast<double>(kMostPaths) * kMostUnits <= 0x1p62);

  double m_unitsInOne;
  float m_mostSquared;
  std::array<std::array<std::int64_t, 4>, kReplicates> m_sums{};
};

}  // namespace metamer::spectral_ref
