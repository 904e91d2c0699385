// SPDX-License-Identifier: Apache-2.0
#include "picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "metamer/spectral/srgb_curve.h"

namespace metamer::playground {
namespace {

/// Of linear light from 0 to 1: where the curve is steepest, five a code.
constexpr int kSteps = 1 << 14;

}  // namespace

Picture::Picture() {
  for (int code = 0; code < 256; ++code) {
    m_linearOfCode.push_back(static_cast<float>(spectral::linearFromSrgb(code / 255.0)));
  }
  for (int step = 0; step <= kSteps; ++step) {
    m_codeOfStep.push_back(
        static_cast<std::uint8_t>(std::lround(255.0 * spectral::srgbFromLinear(step / static_cast<double>(kSteps)))));
  }
}

std::span<std::uint8_t> Picture::room(std::size_t pixelCount) {
  m_codes.assign(4 * pixelCount, 0);
  return m_codes;
}

void Picture::decode() {
  m_linear.resize(m_codes.size());
  m_result.resize(m_codes.size());
  m_shown = m_codes;
  for (std::size_t at = 0; at < m_codes.size(); ++at) {
    m_linear[at] = m_linearOfCode[m_codes[at]];
  }
}

std::span<const std::uint8_t> Picture::through(const sip::HomogeneousMap& map) {
  map.apply(m_linear, m_result);
  for (std::size_t at = 0; at < m_result.size(); at += 4) {
    std::array<std::int32_t, 4> steps;  // alpha too: a whole vector
    for (std::size_t k = 0; k < 4; ++k) {
      const float within = std::min(std::max(0.0F, m_result[at + k]), 1.0F);
      steps[k] = static_cast<std::int32_t>(within * static_cast<float>(kSteps) + 0.5F);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      m_shown[at + k] = m_codeOfStep[static_cast<std::size_t>(steps[k])];
    }
  }
  return m_shown;
}

}  // namespace metamer::playground
