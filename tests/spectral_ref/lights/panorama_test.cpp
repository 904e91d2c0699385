// SPDX-License-Identifier: Apache-2.0
// Panoramas lie the same way round for the renderer and for LED stages.
#include <gtest/gtest.h>

#include "lights/environment_emitter.h"
#include "metamer/stage/stage_geometry.h"

namespace metamer::spectral_ref {
namespace {

TEST(PanoramaTest, ThePixelInADirectionIsTheStages) {
  EmitterPicture picture;
  picture.width = 34;
  picture.height = 17;
  EnvironmentEmitter environment;
  environment.picture = &picture;
  const stage::LatLong layout{picture.width, picture.height};
  for (int row = 0; row < picture.height; ++row) {
    for (int column = 0; column < picture.width; ++column) {
      const Vec3 direction = layout.direction(column, row).cast<float>();
      const auto element = static_cast<std::uint32_t>(row * picture.width + column);
      EXPECT_EQ(environment.elementTowards(direction), element) << column << ", " << row;
      // A sample of the pixel lies within the pixel's size of its middle.
      EXPECT_GT(environment.at(element, 0.5F, 0.5F).direction.dot(direction), 0.999F) << column << ", " << row;
    }
  }
}

}  // namespace
}  // namespace metamer::spectral_ref
