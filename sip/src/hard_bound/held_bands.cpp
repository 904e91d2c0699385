// SPDX-License-Identifier: Apache-2.0
#include "hard_bound/held_bands.h"

#include <algorithm>

namespace metamer::sip {

BandStates statesOf(const ActiveSet& active) {
  BandStates states{};  // all free
  for (const HeldStretch& stretch : active.stretches) {
    std::fill(states.begin() + stretch.first, states.begin() + stretch.end,
              stretch.atOne ? BandState::AtOne : BandState::AtZero);
  }
  return states;
}

ActiveSet activeSetOf(const BandStates& states, int bandCount) {
  ActiveSet active;
  for (int first = 0, end = 0; first < bandCount; first = end) {
    end = endOfStretch(states, first, bandCount);
    const BandState state = states[static_cast<std::size_t>(first)];
    if (state != BandState::Free) {
      active.stretches.push_back(
          {static_cast<std::int16_t>(first), static_cast<std::int16_t>(end), state == BandState::AtOne});
    }
  }
  return active;
}

bool ActiveSet::holds(int band) const {
  return std::any_of(stretches.begin(), stretches.end(),
                     [band](const HeldStretch& stretch) { return stretch.first <= band && band < stretch.end; });
}

ActiveSet between(const ActiveSet& a, const ActiveSet& b) {
  ActiveSet middle = a;
  if (a.stretches.size() != b.stretches.size()) {
    return middle;
  }
  for (std::size_t i = 0; i < a.stretches.size(); ++i) {
    HeldStretch& stretch = middle.stretches[i];
    const HeldStretch& other = b.stretches[i];
    stretch.first = static_cast<std::int16_t>((stretch.first + other.first) / 2);
    stretch.end = static_cast<std::int16_t>((stretch.end + other.end + 1) / 2);
    const bool overlaps = i > 0 && stretch.first <= middle.stretches[i - 1].end;
    if (stretch.atOne != other.atOne || overlaps) {
      return a;
    }
  }
  return middle;
}

}  // namespace metamer::sip
