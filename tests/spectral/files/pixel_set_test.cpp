// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/pixel_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "metamer/spectral/input_error.h"
#include "spectral/fixture.h"
#include "spectral/temporary_folder.h"

namespace metamer::spectral {
namespace {

std::vector<SetPixel> read(const std::string& text) {
  const TemporaryFolder folder;
  std::ofstream(folder / "pixels.csv", std::ios::binary) << text;
  return readPixelSet(folder / "pixels.csv");
}

TEST(PixelSetTest, RowsAreKindsAndColours) {
  const auto pixels = read("kind,red,green,blue\nphotograph,0.5,-0.25,1e-3\nbeyond gamut,1,2,3\n");
  ASSERT_EQ(pixels.size(), 2U);
  EXPECT_EQ(pixels[0].kind, "photograph");
  EXPECT_EQ(pixels[0].rgb, Eigen::Vector3d(0.5, -0.25, 1e-3));
  EXPECT_EQ(pixels[1].kind, "beyond gamut");
}

TEST(PixelSetTest, OtherRowsAreRefused) {
  for (const char* text : {"", "a,b\n", "kind,red,green,blue\nphotograph,0.5,0.25\n",
                           "kind,red,green,blue\nphotograph,0.5,nan,1\n", "kind,red,green,blue\n\n"}) {
    EXPECT_NE(errorOf([&] { read(text); }).find("pixels.csv"), std::string::npos) << text;
  }
}

TEST(PixelSetTest, TheLibrarysAreOfFourKinds) {
  const auto pixels = testLibrary().certificatePixels();
  EXPECT_EQ(pixels.size(), 4096U);
  for (const char* kind : {"photograph", "noisy photograph", "saturated light", "beyond gamut"}) {
    EXPECT_GE(std::count_if(pixels.begin(), pixels.end(), [&](const SetPixel& p) { return p.kind == kind; }), 400);
  }
}

}  // namespace
}  // namespace metamer::spectral
