// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/rgb_space.h"

#include <gtest/gtest.h>

#include "spectral/fixture.h"

namespace metamer::spectral {
namespace {

Eigen::Matrix3d matrixAt(const FixtureRow& row, std::size_t column) {
  Eigen::Matrix3d matrix;
  matrix << row.vector(column).transpose(), row.vector(column + 3).transpose(), row.vector(column + 6).transpose();
  return matrix;
}

TEST(RgbSpaceTest, MatricesEqualColourScience) {
  // Both sides solve the same 3 x 3 systems from the same primaries. The project asks for 1e-6.
  MaxDifference difference("RGB space matrices", 1e-6);
  for (const FixtureRow& row : readFixture("rgb_spaces.csv")) {
    const RgbSpace space = testLibrary().colourSpace(row.text(0)).linear;
    difference.add(space.xyzFromRgb(), matrixAt(row, 1));
    difference.add(space.rgbFromXyz(), matrixAt(row, 10));
  }
}

TEST(RgbSpaceTest, WhiteIsEqualRgb) {
  for (const ColourSpace& space : testLibrary().colourSpaces()) {
    const Eigen::Vector3d white = space.linear.xyzFromRgb() * Eigen::Vector3d::Ones();
    // One solve of a 3 x 3 system.
    EXPECT_LT((white - space.linear.whiteXyz()).norm(), 1e-14) << space.name;
    EXPECT_EQ(space.linear.whiteXyz().y(), 1);
  }
}

TEST(RgbSpaceTest, PrimaryOnTheLineOfNoLuminance) {
  const RgbSpace space{"imaginary", {{{0.7, 0.3}, {0.2, 0.8}, {0.15, 0.0}}}, {0.3127, 0.329}};
  EXPECT_TRUE(space.xyzFromRgb().allFinite());
  EXPECT_EQ(space.xyzFromRgb()(1, 2), 0);
}

}  // namespace
}  // namespace metamer::spectral
