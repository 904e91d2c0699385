// SPDX-License-Identifier: Apache-2.0
#include "bake/ladder.h"

#include <algorithm>

#include "bake/table_sizes.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"

namespace metamer::ocio {
std::vector<Rung> rungsOf(const LutFormat::Content content, bool holdsChain, int largest) {
  std::vector<Rung> rungs = {{Representation::Identity, 0}};
  if (content == LutFormat::Content::Curves) {
    return rungs;
  }
  if (content == LutFormat::Content::Operators) {
    rungs.push_back({Representation::Matrix, 0});
  } else {
    rungs.clear();
  }
  const Representation table = holdsChain ? Representation::ExposureInvariantChain : Representation::LogCube;
  for (const int size : kSizesOfFiles) {
    if (size < largest) {
      rungs.push_back({table, size});
    }
  }
  rungs.push_back({table, largest});
  return rungs;
}

CertifiedChoice climb(const std::vector<Rung>& rungs, double tolerance,
                      const std::function<sip::ErrorProtocol::Report(const Rung&)>& measure) {
  CertifiedChoice choice{tolerance, {}};
  for (const Rung& rung : rungs) {
    const sip::ErrorProtocol::Report error = measure(rung);
    choice.tried.push_back({rung.representation, rung.size, error.p99, error.max});
    if (error.p99 <= tolerance) {
      return choice;
    }
  }
  const auto best = std::min_element(choice.tried.begin(), choice.tried.end(),
                                     [](const auto& a, const auto& b) { return a.p99 < b.p99; });
  throw spectral::InputError("", "tolerance", spectral::threeDigits(tolerance),
                             "nothing here holds it: the best, " + nameOf(best->representation) +
                                 (best->size > 0 ? " of " + std::to_string(best->size) + " nodes" : "") +
                                 ", has a 99th percentile of " + spectral::threeDigits(best->p99) +
                                 "; allow more, fewer stops, a larger size, or write .ctf");
}

}  // namespace metamer::ocio
