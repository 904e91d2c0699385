// SPDX-License-Identifier: Apache-2.0
// A colour shot in daylight, shown under tungsten.
#include <cmath>
#include <cstdio>
#include <exception>

#include "metamer/sip/recipe.h"
#include "metamer/sip/spectral_transform.h"
#include "metamer/spectral/data_library.h"

namespace {

int transformOneColour() {
  const auto library = metamer::spectral::DataLibrary::open(METAMER_DATA_FOLDER);
  const auto recipe = metamer::sip::parseRecipe(
      "metamer: 1\n"
      "space: ACEScg\n"
      "input: {illuminant: D65}\n"
      "output: {illuminant: A, adaptation: 1.0}\n",
      "the consumer's recipe");
  const metamer::sip::SpectralTransform transform(metamer::sip::resolve(recipe, library));

  const Eigen::Vector3d colour(0.2, 0.5, 0.3);
  const Eigen::Vector3d result = transform.apply(colour);
  const Eigen::Vector3d brighter = transform.apply(1024.0 * colour);
  const Eigen::Vector3d grey = transform.apply(Eigen::Vector3d(0.18, 0.18, 0.18));
  std::printf("%g %g %g -> %g %g %g\n", colour[0], colour[1], colour[2], result[0], result[1], result[2]);

  // Full adaptation keeps neutrals; exposure passes through; tungsten does change a green.
  const bool neutral = (grey - Eigen::Vector3d(0.18, 0.18, 0.18)).norm() < 1e-9;
  const bool homogeneous = (brighter - 1024.0 * result).norm() < 1e-9 * brighter.norm();
  const bool changed = (result - colour).norm() > 1e-3;
  if (!neutral || !homogeneous || !changed) {
    std::fprintf(stderr, "neutral %d, homogeneous %d, changed %d\n", neutral, homogeneous, changed);
    return 1;
  }
  return 0;
}

}  // namespace

int main() {
  try {
    return transformOneColour();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
