// SPDX-License-Identifier: Apache-2.0
#include "materials/fluorescence_table.h"

namespace metamer::spectral_ref {
namespace {

/// Part of the light that is taken for even: what surfaces make of it is not known beforehand.
constexpr double kEvenShare = 0.2;

}  // namespace

FluorescenceTable::FluorescenceTable(const spectral::FluorescentSamples& surface,
                                     const spectral::ExcitationSamples& light) {
  const double mean = light.mean();
  for (const double value : light) {
    m_light.push_back(static_cast<float>(mean > 0 ? (1.0 - kEvenShare) * value / mean + kEvenShare : 1.0));
  }
  m_below.reserve(m_light.size() * (m_light.size() + 1) / 2);
  for (Eigen::Index emission = 0; emission < spectral::kExcitationSize; ++emission) {
    double sum = 0;
    m_below.push_back(0.0F);
    for (Eigen::Index excitation = 0; excitation < emission; ++excitation) {
      sum += surface.perNm(emission, excitation) * static_cast<double>(m_light[static_cast<std::size_t>(excitation)]);
      m_below.push_back(static_cast<float>(sum));
    }
  }
}

}  // namespace metamer::spectral_ref
