// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/correlated_colour_temperature.h"

#include <gtest/gtest.h>

#include "metamer/spectral/colorimetry.h"
#include "metamer/spectral/illuminants.h"
#include "spectral/fixture.h"

namespace metamer::spectral {
namespace {

CorrelatedColourTemperature of(const Eigen::Vector3d& xyz) {
  static const Eigen::Matrix<double, 401, 3> observer = testLibrary().observer("CIE 1931 2").onDomain();
  return correlatedColourTemperature(xyz, observer);
}

TEST(CorrelatedColourTemperatureTest, EqualsDirectMinimisation) {
  // Both find the root of the same derivative; the fixture's chromaticities carry twelve decimals.
  MaxDifference kelvin("CCT against direct minimisation, K", 1e-4);
  MaxDifference duv("Duv against direct minimisation", 1e-9);
  for (const FixtureRow& row : readFixture("cct.csv")) {
    const CorrelatedColourTemperature result = of(row.vector(0));
    kelvin.add(result.cctK, row.number(3));
    duv.add(result.duv, row.number(4));
  }
}

TEST(CorrelatedColourTemperatureTest, AgreesWithOhno) {
  // colour-science's Planck constant is rounded: 1.6e-5 of the temperature; the method's own parabola adds 6e-6.
  MaxDifference kelvin("CCT against Ohno 2013, relative", 5e-5);
  MaxDifference duv("Duv against Ohno 2013", 1e-6);
  for (const FixtureRow& row : readFixture("cct.csv")) {
    const CorrelatedColourTemperature result = of(row.vector(0));
    kelvin.add(result.cctK / row.number(5), 1);
    duv.add(result.duv, row.number(6));
  }
}

TEST(CorrelatedColourTemperatureTest, BlackbodiesAreOnTheLocus) {
  const Observer observer = testLibrary().observer("CIE 1931 2");
  for (const double kelvin : {1000.0, 1001.0, 2856.0, 6500.0, 25000.0, 99000.0}) {
    const CorrelatedColourTemperature result = of(response(blackbody(kelvin), observer));
    // Chromaticity is rounded to 1e-16; one mired is kelvin^2 / 1e6 K.
    EXPECT_NEAR(result.cctK, kelvin, 1e-13 * kelvin * kelvin) << kelvin;
    EXPECT_NEAR(result.duv, 0, 1e-14);
  }
}

TEST(CorrelatedColourTemperatureTest, SignOfDuv) {
  EXPECT_GT(of(xyzFromChromaticity({0.38, 0.42})).duv, 0);
  EXPECT_LT(of(xyzFromChromaticity({0.38, 0.33})).duv, 0);
}

TEST(CorrelatedColourTemperatureTest, EndsOfTheRange) {
  EXPECT_NEAR(of(xyzFromChromaticity({0.7, 0.29})).cctK, 1000, 1e-6);     // deep red
  EXPECT_NEAR(of(xyzFromChromaticity({0.20, 0.20})).cctK, 100000, 1e-6);  // bluer than the locus goes
}

}  // namespace
}  // namespace metamer::spectral
