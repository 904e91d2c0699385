// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/illuminants.h"

#include <gtest/gtest.h>

#include "spectral/fixture.h"

namespace metamer::spectral {
namespace {

TEST(IlluminantsTest, BlackbodyEqualsColourScience) {
  // Both evaluate Planck's law with the same constants; 100000 K is compared relative to its size.
  MaxDifference difference("blackbody", 1e-9);
  for (const FixtureRow& row : readFixture("blackbody.csv")) {
    difference.addRelative(blackbody(row.number(0)).at(row.number(1)), row.number(2));
  }
}

TEST(IlluminantsTest, DaylightEqualsColourScience) {
  // The same polynomials, weights rounded to three decimals on both sides. The project asks for 1e-6.
  MaxDifference difference("daylight", 1e-6);
  for (const FixtureRow& row : readFixture("daylight.csv")) {
    const Spectrum light = testLibrary().illuminant("daylight " + row.text(0) + " K");
    difference.add(light.at(row.number(1)), row.number(2));
  }
}

TEST(IlluminantsTest, DaylightOf6504IsD65) {
  const Spectrum model = testLibrary().illuminant("daylight 6504 K");
  const Spectrum table = testLibrary().illuminant("D65");
  // The standard's table follows from the nominal temperature times 1.4388/1.4380, 6503.6 K, and is rounded to six
  // digits: the rounded weights differ by at most 0.001 of components that reach 60.
  for (int nm = 380; nm <= 780; nm += 5) {
    EXPECT_NEAR(model.at(nm), table.at(nm) / 100, 1e-3) << nm;
  }
}

TEST(IlluminantsTest, Shapes) {
  const SpectralShape shape = blackbody(3200).shape();
  EXPECT_EQ(shape.startNm, 300);
  EXPECT_EQ(shape.endNm, 830);
  EXPECT_EQ(shape.intervalNm, 1);
  EXPECT_EQ(testLibrary().illuminant("daylight 5600 K").shape().intervalNm, 5);
  EXPECT_EQ(blackbody(3200).at(560), 1);
}

TEST(IlluminantsTest, OutsideTheRangeIsRefused) {
  EXPECT_EQ(errorOf([] { blackbody(499); }), "blackbody temperature '499 K': must lie between 500 and 100000 K");
  EXPECT_EQ(errorOf([] { testLibrary().illuminant("daylight 3999 K"); }),
            "daylight temperature '3999 K': must lie between 4000 and 25000 K");
  EXPECT_NO_THROW(blackbody(500));
  EXPECT_NO_THROW(blackbody(100000));
}

}  // namespace
}  // namespace metamer::spectral
