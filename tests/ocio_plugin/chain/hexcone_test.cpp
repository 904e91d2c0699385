// SPDX-License-Identifier: Apache-2.0
#include "chain/hexcone.h"

#include <OpenColorIO/OpenColorIO.h>
#include <gtest/gtest.h>

#include <random>

#include "metamer/ocio/pixel_processor.h"

namespace metamer::ocio {
namespace {

std::vector<Eigen::Vector3d> directions() {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::vector<Eigen::Vector3d> result = {{1, 1, 1},  {-1, -1, -1}, {0, 0, 0}, {1, 0, 0},
                                         {-1, 0, 0}, {1, 1, 0},    {0, 1, 1}};
  for (int k = 0; k < 2000; ++k) {
    result.emplace_back(normal(random), normal(random), normal(random));
  }
  return result;
}

TEST(HexconeTest, IsWhatOcioHas) {
  auto group = OCIO::GroupTransform::Create();
  group->appendTransform(OCIO::FixedFunctionTransform::Create(OCIO::FIXED_FUNCTION_RGB_TO_HSV));
  const PixelProcessor processor(group);
  for (const Eigen::Vector3d& rgb : directions()) {
    const Eigen::Vector3f in = rgb.cast<float>();
    std::array<float, 4> pixel = {in[0], in[1], in[2], 1.0F};
    processor.apply(pixel);
    const Hexcone hexcone = hexconeOf(in.cast<double>());
    EXPECT_NEAR(pixel[0], hexcone.hue, 1e-5) << rgb.transpose();
    EXPECT_NEAR(pixel[1], hexcone.saturation, 1e-5) << rgb.transpose();
    EXPECT_NEAR(pixel[2], hexcone.value, 1e-5) << rgb.transpose();
  }
}

TEST(HexconeTest, EveryColourComesBack) {
  for (const Eigen::Vector3d& rgb : directions()) {
    const Hexcone hexcone = hexconeOf(rgb);
    EXPECT_GE(hexcone.saturation, 0.0);
    EXPECT_LE(hexcone.saturation, 2.0);
    if (hexcone.saturation < 2.0 - 1e-4) {
      EXPECT_LE((colourOf(hexcone) - rgb).norm(), 1e-10 * (1.0 + rgb.norm())) << rgb.transpose();
    }
  }
}

TEST(HexconeTest, ExposureChangesTheValueAlone) {
  for (const Eigen::Vector3d& rgb : directions()) {
    const Hexcone one = hexconeOf(rgb);
    const Hexcone other = hexconeOf(8.0 * rgb);
    EXPECT_EQ(one.hue, other.hue);
    EXPECT_EQ(one.saturation, other.saturation);
    EXPECT_EQ(8.0 * one.value, other.value);
  }
}

}  // namespace
}  // namespace metamer::ocio
