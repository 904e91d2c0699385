// SPDX-License-Identifier: Apache-2.0
#include "metamer/skin/skin_edit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "spectral/refusals.h"

namespace metamer::skin {
namespace {

using Pixels = std::span<SkinPixel>;

SkinPixel usual() {
  SkinPixel pixel;
  pixel.skin = {0.03F, 0.02F, 90, 0.2F, 0.4F};
  pixel.gain = 1.5F;
  pixel.residual = {0.01F, -0.02F, 0.03F};
  return pixel;
}

template <typename Edit>
SkinPixel after(const Edit& edit) {
  SkinPixel pixel = usual();
  edit(Pixels(&pixel, 1));
  EXPECT_EQ(pixel.gain, usual().gain);
  EXPECT_EQ(pixel.residual, usual().residual);
  return pixel;
}

TEST(SkinEdit, DoesWhatItSays) {
  EXPECT_FLOAT_EQ(after([](Pixels p) { multiplySkin(p, SkinQuantity::Blood, 1.5); }).skin[1], 0.03F);
  EXPECT_FLOAT_EQ(after([](Pixels p) { setSkin(p, SkinQuantity::Thickness, 120); }).skin[2], 120);
  EXPECT_FLOAT_EQ(after([](Pixels p) { oxygenateSkin(p, 0.5); }).skin[4], 0.2F);
  EXPECT_FLOAT_EQ(after([](Pixels p) { oxygenateSkin(p, -0.5); }).skin[4], 0.7F);
  EXPECT_FLOAT_EQ(after([](Pixels p) { thickenSkin(p, 0.5); }).skin[2], 45);
  EXPECT_FLOAT_EQ(after([](Pixels p) { bleachSkin(p, 1); }).skin[0], 0);
  const SkinPixel tanned = after([](Pixels p) { tanSkin(p, 1); });
  EXPECT_FLOAT_EQ(tanned.skin[0], 0.06F);
  EXPECT_FLOAT_EQ(tanned.skin[2], 99);
  EXPECT_FLOAT_EQ(tanned.skin[3], 0.4F);
  const SkinPixel flushed = after([](Pixels p) { flushSkin(p, 1); });
  EXPECT_FLOAT_EQ(flushed.skin[1], 0.04F);
  EXPECT_FLOAT_EQ(flushed.skin[4], 0.2F);
}

TEST(SkinEdit, StaysWithinTheRanges) {
  SkinPixel pixel = usual();
  multiplySkin({&pixel, 1}, SkinQuantity::Melanin, 1000);
  thickenSkin({&pixel, 1}, 100);
  EXPECT_EQ(pixel.skin[0], 1);
  EXPECT_EQ(pixel.skin[2], 350);
  thickenSkin({&pixel, 1}, 0.01);
  EXPECT_EQ(pixel.skin[2], 10);
}

TEST(SkinEdit, GoesByTheMatte) {
  std::vector<SkinPixel> pixels(6, usual());
  const std::vector<float> matte = {0, 0.5F, 1, -3, 7, std::numeric_limits<float>::quiet_NaN()};
  setSkin(pixels, SkinQuantity::Blood, 0.1, matte);
  const std::vector<float> expected = {0.02F, 0.06F, 0.1F, 0.02F, 0.1F, 0.02F};
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    EXPECT_FLOAT_EQ(pixels[i].skin[1], expected[i]) << i;
  }
}

TEST(SkinEdit, SmoothsOverAPicture) {
  constexpr int kWidth = 7;
  std::vector<SkinPixel> pixels(kWidth * 5, usual());
  smoothSkin(pixels, SkinQuantity::Melanin, kWidth, 2);
  for (const SkinPixel& pixel : pixels) {
    EXPECT_NEAR(pixel.skin[0], 0.03F, 1e-7F);
  }
  pixels[17].skin[0] = 0.3F;
  smoothSkin(pixels, SkinQuantity::Melanin, kWidth, 1);
  // A spot spreads over its neighbours alike, as exp(-1/2) of what stays in it; down, the picture's ends lie nearer.
  EXPECT_LT(pixels[17].skin[0], 0.1F);
  EXPECT_NEAR(pixels[16].skin[0], pixels[18].skin[0], 1e-6F);
  EXPECT_NEAR(pixels[10].skin[0], pixels[24].skin[0], 1e-6F);
  EXPECT_NEAR((pixels[16].skin[0] - 0.03F) / (pixels[17].skin[0] - 0.03F), std::exp(-0.5), 0.02);
  EXPECT_EQ(pixels[16].skin[1], 0.02F);
}

TEST(SkinEdit, RefusesWhatIsOutOfRange) {
  std::vector<SkinPixel> pixels(4, usual());
  const std::vector<float> three(3, 1.0F);
  EXPECT_TAKEN(smoothSkin(pixels, SkinQuantity::Blood, 2, 1000));
  EXPECT_TAKEN(tanSkin({}, 1));
  EXPECT_REFUSED("factor '-1'", multiplySkin(pixels, SkinQuantity::Blood, -1));
  EXPECT_REFUSED("factor '1001'", multiplySkin(pixels, SkinQuantity::Blood, 1001));
  EXPECT_REFUSED("matte '3'", multiplySkin(pixels, SkinQuantity::Blood, 1, three));
  EXPECT_REFUSED("thickness '9'", setSkin(pixels, SkinQuantity::Thickness, 9));
  EXPECT_REFUSED("blood 'nan'", setSkin(pixels, SkinQuantity::Blood, std::nan("")));
  EXPECT_REFUSED("radius '0'", smoothSkin(pixels, SkinQuantity::Blood, 2, 0));
  EXPECT_REFUSED("radius '1001'", smoothSkin(pixels, SkinQuantity::Blood, 2, 1001));
  EXPECT_REFUSED("width '3'", smoothSkin(pixels, SkinQuantity::Blood, 3, 1));
  EXPECT_REFUSED("width '0'", smoothSkin(pixels, SkinQuantity::Blood, 0, 1));
  EXPECT_REFUSED("strength '5'", tanSkin(pixels, 5));
  EXPECT_REFUSED("strength '-1'", tanSkin(pixels, -1));
  EXPECT_REFUSED("strength '-0.95'", flushSkin(pixels, -0.95));
  EXPECT_REFUSED("strength '1.5'", oxygenateSkin(pixels, 1.5));
  EXPECT_REFUSED("factor '0'", thickenSkin(pixels, 0));
  EXPECT_REFUSED("strength '2'", bleachSkin(pixels, 2));
  EXPECT_REFUSED("quantity 'lipstick'", skinQuantityFromName("lipstick"));
}

}  // namespace
}  // namespace metamer::skin
