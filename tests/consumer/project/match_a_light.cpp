// SPDX-License-Identifier: Apache-2.0
// Tungsten from three LEDs.
#include <cstdio>
#include <exception>

#include "metamer/spectral/data_library.h"
#include "metamer/stage/match_outcome.h"

namespace {

int matchALight() {
  const auto library = metamer::spectral::DataLibrary::open(METAMER_DATA_FOLDER);
  const auto fixture = metamer::stage::readFixture({"led:628:14", "led:525:24", "led:460:16"}, library);
  const auto outcome =
      metamer::stage::matchSpectra({.method = "mim"}, fixture, library.illuminant("A"), library.observer("CIE 1931 2"),
                                   library.reflectances("colorchecker").samples, Eigen::Matrix3d::Identity());
  for (std::size_t k = 0; k < fixture.names.size(); ++k) {
    std::printf("%-12s %.4f\n", fixture.names[k].c_str(), outcome.match.drives[static_cast<Eigen::Index>(k)]);
  }
  const bool lit = outcome.match.drives.minCoeff() > 0;
  const bool matched = outcome.match.relativeResidual < 1e-9;
  // One colour of white is not one spectrum: the chart tells the lights apart.
  const bool metameric = (outcome.made - outcome.wanted).norm() > 1e-3 * outcome.wanted.norm();
  if (!lit || !matched || !metameric) {
    std::fprintf(stderr, "lit %d, matched %d, metameric %d\n", lit, matched, metameric);
    return 1;
  }
  return 0;
}

}  // namespace

int main() {
  try {
    return matchALight();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
