// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/chromatic_adaptation.h"

#include <gtest/gtest.h>

#include "spectral/fixture.h"

namespace metamer::spectral {
namespace {

TEST(ChromaticAdaptationTest, EqualsColourScience) {
  // The same published matrices; what differs is the rounding of one matrix inverse. The project asks for 1e-6.
  MaxDifference difference("chromatic adaptation", 1e-6);
  for (const FixtureRow& row : readFixture("chromatic_adaptation.csv")) {
    const Eigen::Matrix3d adapt = adaptXyz(chromaticAdaptationFromName(row.text(0)), row.vector(1), row.vector(4));
    difference.add(adapt * row.vector(7), row.vector(10));
  }
}

TEST(ChromaticAdaptationTest, WhiteGoesToWhite) {
  const Eigen::Vector3d source(1.1, 1, 0.4);
  const Eigen::Vector3d destination(0.95, 1, 1.09);
  for (const char* const name : {"vonkries", "bradford", "cat02", "cat16"}) {
    const Eigen::Matrix3d adapt = adaptXyz(chromaticAdaptationFromName(name), source, destination);
    // A 3 x 3 inverse of condition below 10: rounding only.
    EXPECT_LT((adapt * source - destination).norm(), 1e-14) << name;
  }
}

TEST(ChromaticAdaptationTest, SpacesAreAdaptedFromWhiteToWhite) {
  const RgbSpace aces = testLibrary().colourSpace("ACEScg").linear;
  const RgbSpace rec709 = testLibrary().colourSpace("Rec.709").linear;
  const Eigen::Matrix3d there = adaptRgb(ChromaticAdaptation::Bradford, aces, rec709);
  EXPECT_LE((there * Eigen::Vector3d::Ones() - Eigen::Vector3d::Ones()).cwiseAbs().maxCoeff(), 1e-14);
  // Another colour is another one's numbers, and comes back.
  EXPECT_GT((there - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 0.1);
  const Eigen::Matrix3d back = adaptRgb(ChromaticAdaptation::Bradford, rec709, aces);
  EXPECT_LE((back * there - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(ChromaticAdaptationTest, Names) {
  for (const char* const name : {"vonkries", "bradford", "cat02", "cat16"}) {
    EXPECT_EQ(nameOf(chromaticAdaptationFromName(name)), name);
  }
  EXPECT_EQ(chromaticAdaptationFromName("CAT16"), ChromaticAdaptation::Cat16);
  EXPECT_EQ(errorOf([] { chromaticAdaptationFromName("cat97"); }),
            "chromatic adaptation 'cat97': must be vonkries, bradford, cat02 or cat16");
}

TEST(ChromaticAdaptationTest, WhiteWithoutConeResponseIsRefused) {
  const Eigen::Vector3d daylight(0.95, 1, 1.09);
  EXPECT_EQ(errorOf([&] {
              adaptXyz(ChromaticAdaptation::Bradford, {0, 0, 0}, daylight);
            }),
            "white '0 0 0': has no positive cone response under 'bradford': adapt to a less saturated light or use "
            "another chromatic adaptation");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(errorOf([&] { adaptXyz(ChromaticAdaptation::Cat02, daylight, {nan, 1, 1}); }), "no InputError");
}

}  // namespace
}  // namespace metamer::spectral
