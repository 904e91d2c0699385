// SPDX-License-Identifier: Apache-2.0
#include "materials/conductor.h"

namespace metamer::spectral_ref {

GgxEnergy::GgxEnergy(float alpha) {
  const Ggx ggx{alpha};
  constexpr int kSteps = 64;
  for (int node = 0; node < kNodes; ++node) {
    const float cosine = std::max(static_cast<float>(node) / (kNodes - 1), 1e-3F);
    const Vec3 out(std::sqrt(1.0F - cosine * cosine), 0.0F, cosine);
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; j < kSteps; ++j) {
        const Vec3 h =
            ggx.sampleVisible(out, (static_cast<float>(i) + 0.5F) / kSteps, (static_cast<float>(j) + 0.5F) / kSteps);
        const Vec3 in = 2.0F * out.dot(h) * h - out;
        if (in.z() > 0.0F) {
          sum += static_cast<double>(ggx.maskingShadowing(out, in) / ggx.masking(out));
        }
      }
    }
    m_at[static_cast<std::size_t>(node)] = static_cast<float>(sum / (kSteps * kSteps));
  }
  constexpr int kMeanSteps = 1024;
  double mean = 0;
  for (int i = 0; i < kMeanSteps; ++i) {
    const double cosine = (i + 0.5) / kMeanSteps;
    mean += 2.0 * cosine * static_cast<double>(at(static_cast<float>(cosine))) / kMeanSteps;
  }
  m_mean = static_cast<float>(mean);
}

}  // namespace metamer::spectral_ref
