// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/colour_space.h"

#include <gtest/gtest.h>

#include "spectral/fixture.h"

namespace metamer::spectral {
namespace {

TEST(ColourSpaceTest, LogSpacesThenLinearSpaces) {
  const std::vector<ColourSpace> spaces = testLibrary().colourSpaces();
  ASSERT_EQ(spaces.size(), 23U);
  EXPECT_EQ(spaces[0].name, "ACEScct");
  EXPECT_EQ(spaces[0].linear.name, "ACEScg");
  EXPECT_EQ(spaces[0].encoding, LogEncoding::AcesCct);
  EXPECT_EQ(spaces[4].name, "S-Log3 S-Gamut3.Cine");
  EXPECT_EQ(spaces[4].linear.name, "S-Gamut3.Cine");
  EXPECT_EQ(spaces[10].name, "ACEScg");
  EXPECT_FALSE(spaces[10].encoding.has_value());
}

TEST(ColourSpaceTest, LogSpacesWithoutTheirLinearSpaceAreLeftOut) {
  const RgbSpace aces{"ACEScg", {{{0.713, 0.293}, {0.165, 0.83}, {0.128, 0.044}}}, {0.32168, 0.33767}};
  const std::vector<ColourSpace> spaces = colourSpaces({aces});
  ASSERT_EQ(spaces.size(), 2U);
  EXPECT_EQ(spaces[0].name, "ACEScct");
  EXPECT_EQ(spaces[1].name, "ACEScg");
}

}  // namespace
}  // namespace metamer::spectral
