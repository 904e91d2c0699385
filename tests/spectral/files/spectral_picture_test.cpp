// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/spectral_picture.h"

#include <gtest/gtest.h>

#include "metamer/spectral/spectral_files.h"
#include "spectral/fixture.h"

namespace metamer::spectral {
namespace {

using Quantity = SpectralQuantity;

TEST(SpectralPictureTest, ChannelsAreNamedAsTheyAreRead) {
  EXPECT_EQ(channelOfWavelength(550.0, SpectralQuantity::Reflectance), "T.550,000000nm");
  EXPECT_EQ(channelOfWavelength(380.25, SpectralQuantity::SpectralPowerDistribution), "S0.380,250000nm");
  for (const double nm : {300.0, 412.5, 1000.0}) {
    const auto read =
        channelWavelengthNm(channelOfWavelength(nm, SpectralQuantity::Transmittance), SpectralQuantity::Transmittance);
    ASSERT_TRUE(read.has_value());
    EXPECT_NEAR(*read, nm, 1e-9);
  }
}

TEST(SpectralPictureTest, ChannelsOfTheLayout) {
  constexpr auto kLight = Quantity::SpectralPowerDistribution;
  EXPECT_DOUBLE_EQ(channelWavelengthNm("S0.550,000000nm", kLight).value(), 550.0);
  EXPECT_DOUBLE_EQ(channelWavelengthNm("left.S0.550.5nm", kLight).value(), 550.5);
  EXPECT_NEAR(channelWavelengthNm("S0.0,55um", kLight).value(), 550.0, 1e-9);
  EXPECT_NEAR(channelWavelengthNm("S0.600THz", kLight).value(), 499.654096666667, 1e-9);
  EXPECT_NEAR(channelWavelengthNm("T.0,0004mm", Quantity::Transmittance).value(), 400.0, 1e-9);
  for (const char* other : {"R", "S1.550,000000nm", "T.550,000000nm", "AS0.550nm", "S0.nm", "S0.550", "S0.550ly",
                            "S0.0nm", "S0.5.5.5nm", "S0.-5nm", "S0.5,5E-7m"}) {
    EXPECT_FALSE(channelWavelengthNm(other, kLight)) << other;
  }
}

TEST(SpectralPictureTest, ReadsByTheProgramsReader) {
  const auto reader = [](const std::string& file, const std::optional<PicturePlace>& place, const auto& isWanted) {
    EXPECT_EQ(file, "sky.exr");
    EXPECT_FALSE(isWanted("R"));
    EXPECT_TRUE(isWanted("S0.500nm"));
    const double gain = place ? 10.0 * place->x + place->y : 1.0;
    return std::vector<ChannelValue>{{"S0.600nm", gain}, {"S0.500nm", 0.5 * gain}};
  };
  const auto mean = readSpectralFile("sky.exr", Quantity::SpectralPowerDistribution, reader);
  ASSERT_EQ(mean.size(), 1U);
  EXPECT_EQ(mean[0].name(), "sky");
  EXPECT_DOUBLE_EQ(mean[0].at(550.0), 0.75);
  EXPECT_DOUBLE_EQ(readSpectralFile("sky.exr:3,-1", Quantity::SpectralPowerDistribution, reader)[0].at(600.0), 29.0);
  const std::string none = errorOf([] { readSpectralFile("sky.exr", Quantity::SpectralPowerDistribution); });
  EXPECT_NE(none.find("lutgen"), std::string::npos) << none;
}

}  // namespace
}  // namespace metamer::spectral
