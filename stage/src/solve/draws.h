// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "metamer/stage/wall_intervals.h"

namespace metamer::stage {

/// @throws spectral::InputError: noise or a number of samples out of range
void requireDraws(const IntervalOptions& options);

/// Calls body for each sample, as the options run them.
void runDraws(const IntervalOptions& options, const std::function<void(int)>& body);

/// Adds a sample's noise to values one after another.
class Noise {
 public:
  Noise(const IntervalOptions& options, std::uint64_t sample) : m_options(options), m_sample(sample) {}

  template <typename Values>
  void add(Values& values) {
    for (double& value : values.reshaped()) {
      value += next(value);
    }
  }

 private:
  double next(double value);

  const IntervalOptions& m_options;
  std::uint64_t m_sample;
  std::uint64_t m_place = 0;
};

}  // namespace metamer::stage
