// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace metamer::spectral_ref {

/// Cutting a polygon into triangles takes time by the square of its corners. Large polygons of a file
/// may together take some seconds, as one of 2,000 corners or 240 of 128 do.
class PolygonBudget {
 public:
  static constexpr const char* kRemedy = "corners, beside other large polygons, take too long to cut; export triangles";

  /// @return whether there is time for one polygon more
  bool allows(std::uint64_t corners) {
    constexpr std::uint64_t kSmall = 64;
    constexpr std::uint64_t kMostSquares = 4'000'000;
    corners = std::min(corners, kMostSquares);
    m_squares += corners > kSmall ? corners * corners : 0;
    return m_squares <= kMostSquares;
  }

 private:
  std::uint64_t m_squares = 0;
};

}  // namespace metamer::spectral_ref
