// SPDX-License-Identifier: Apache-2.0
#include "metamer/validation/foliage.h"

namespace metamer::validation {
namespace {

bool isFoliage(const spectral::Spectrum& sample) {
  const double green = sample.at(550);
  return sample.at(740) > 3 * sample.at(675) && green > 1.2 * sample.at(480) && green > 1.2 * sample.at(670);
}

}  // namespace

std::vector<spectral::Spectrum> foliageAmong(const std::vector<spectral::Spectrum>& samples) {
  std::vector<spectral::Spectrum> leaves;
  for (const spectral::Spectrum& sample : samples) {
    if (isFoliage(sample)) {
      leaves.push_back(sample);
    }
  }
  return leaves;
}

}  // namespace metamer::validation
