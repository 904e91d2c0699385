// SPDX-License-Identifier: Apache-2.0
// The skin of a colour, and the colour with more blood in it.
#include <cstdio>
#include <exception>

#include "metamer/skin/skin_edit.h"
#include "metamer/skin/skin_estimator.h"
#include "metamer/spectral/data_library.h"

namespace {

int skinOfAColour() {
  const auto library = metamer::spectral::DataLibrary::open(METAMER_DATA_FOLDER);
  const metamer::skin::SkinView view(library.illuminant("D65"), library.observer("CIE 1931 2"),
                                     library.colourSpace("Rec.709").linear);
  const metamer::skin::SkinEstimator estimator(library, view);
  const Eigen::Vector3f colour(0.5F, 0.33F, 0.24F);
  metamer::skin::SkinPixel pixel = estimator.estimate(colour);
  const bool returns = (estimator.colour(pixel) - colour).norm() < 1e-6F;
  metamer::skin::multiplySkin({&pixel, 1}, metamer::skin::SkinQuantity::Blood, 1.5);
  const Eigen::Vector3f flushed = estimator.colour(pixel);
  const bool isRedder = flushed[0] / flushed[1] > colour[0] / colour[1];
  std::printf("melanin %.3f, blood %.3f; returns %d, redder %d\n", static_cast<double>(pixel.skin[0]),
              static_cast<double>(pixel.skin[1]), returns, isRedder);
  return returns && isRedder ? 0 : 1;
}

}  // namespace

int main() {
  try {
    return skinOfAColour();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
