// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "metamer/sip/homogeneous_map.h"

namespace metamer::playground {

/// A picture as a page has it, sRGB codes red, green, blue, alpha, and as it looks through a map of linear Rec.709.
class Picture {
 public:
  Picture();

  /// Room for the codes of a new picture; taken over by decode().
  std::span<std::uint8_t> room(std::size_t pixelCount);
  void decode();

  /// Codes through the map: what is beyond the screen's range is clipped. Alpha is kept.
  std::span<const std::uint8_t> through(const sip::HomogeneousMap& map);

 private:
  std::vector<std::uint8_t> m_codes;
  std::vector<float> m_linear;
  std::vector<float> m_result;
  std::vector<std::uint8_t> m_shown;
  std::vector<float> m_linearOfCode;
  std::vector<std::uint8_t> m_codeOfStep;
};

}  // namespace metamer::playground
