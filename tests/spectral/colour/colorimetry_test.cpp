// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/colorimetry.h"

#include <gtest/gtest.h>

#include <cmath>

#include "metamer/spectral/spectral_files.h"
#include "spectral/fixture.h"

namespace metamer::spectral {
namespace {

// Sums of 401 terms and cube roots in another order: rounding errors stay below 1e-12; colour-science's own constants
// are the same exact fractions. The project asks for 1e-6.
constexpr double kOracleTolerance = 1e-6;

TEST(ColorimetryTest, TristimulusEqualsColourScience) {
  const std::vector<Spectrum> reflectances =
      readSpectralFile(std::string(METAMER_ORACLE_FOLDER) + "/reflectances.csv", SpectralQuantity::Reflectance);
  MaxDifference difference("tristimulus", kOracleTolerance);
  MaxDifference xyDifference("chromaticity", kOracleTolerance);
  for (const FixtureRow& row : readFixture("tristimulus.csv")) {
    const Spectrum light = testLibrary().illuminant(row.text(0));
    const Observer observer = testLibrary().observer(row.text(1));
    const auto& reflectance = reflectances.at(static_cast<std::size_t>(std::stoi(row.text(2).substr(1))));
    const Eigen::Vector3d xyz = tristimulus(reflectance, light, observer);
    difference.add(xyz, row.vector(3));
    xyDifference.add(chromaticity(xyz), Eigen::Vector2d(row.number(6), row.number(7)));
  }
}

TEST(ColorimetryTest, PerfectReflectorHasUnitLuminance) {
  const Spectrum white("white", SpectralQuantity::Reflectance, {380, 780}, {1, 1});
  for (const char* const observer : {"CIE 1931 2", "Nikon D5100"}) {
    // Exact but for the rounding of one division.
    EXPECT_NEAR(tristimulus(white, testLibrary().illuminant("HP1"), testLibrary().observer(observer))[1], 1, 1e-15);
  }
}

TEST(ColorimetryTest, ResponseIsTheIntegralOfALine) {
  const Spectrum line("line", SpectralQuantity::SpectralPowerDistribution, {549, 550, 551}, {0, 2, 0});
  const Observer observer = testLibrary().observer("CIE 1931 2");
  const auto curves = observer.onDomain();
  // Two triangles between whole nanometres, by hand; rounding of a sum of ten.
  const Eigen::Vector3d expected = 2 * (curves.row(169) + 4 * curves.row(170) + curves.row(171)) / 6;
  EXPECT_LT((response(line, observer) - expected).norm(), 1e-14);
}

TEST(ColorimetryTest, ResponseToAPrintedTableIsThePlainSum) {
  const Spectrum light = testLibrary().illuminant("FL11");
  const Observer observer = testLibrary().observer("CIE 1931 2");
  Eigen::Vector3d expected = Eigen::Vector3d::Zero();
  for (int i = 0; i < kDomainSize; ++i) {
    expected += light.at(kDomainStartNm + i) * observer.onDomain().row(i).transpose();
  }
  // The same terms in another order.
  EXPECT_LT((response(light, observer) - expected).norm(), 1e-12 * expected.norm());
}

TEST(ColorimetryTest, DarkLightIsRefused) {
  const Spectrum white("white", SpectralQuantity::Reflectance, {380, 780}, {1, 1});
  const Spectrum dark("dark", SpectralQuantity::SpectralPowerDistribution, {380, 780}, {0, 0});
  EXPECT_EQ(errorOf([&] { tristimulus(white, dark, testLibrary().observer("CIE 1931 2")); }),
            "dark: light: gives observer 'CIE 1931 2' no response in 380 to 780 nm");
}

TEST(ColorimetryTest, ChromaticityOfBlackIsZero) {
  EXPECT_EQ(chromaticity({0, 0, 0}), Eigen::Vector2d(0, 0));
  EXPECT_EQ(chromaticity({-1, 0.5, 0.25}), Eigen::Vector2d(0, 0));
  EXPECT_EQ(chromaticityUv({0, 0, 0}), Eigen::Vector2d(0, 0));
}

TEST(ColorimetryTest, ChromaticityRoundTrip) {
  const Eigen::Vector3d xyz(0.3, 0.5, 0.9);
  // Two divisions: a few units in the last place.
  EXPECT_LT((xyzFromChromaticity(chromaticity(xyz), 0.5) - xyz).norm(), 1e-15);
}

TEST(ColorimetryTest, LabAndUvEqualColourScience) {
  MaxDifference labDifference("lab", kOracleTolerance);
  MaxDifference uvDifference("u'v'", kOracleTolerance);
  for (const FixtureRow& row : readFixture("lab.csv")) {
    const Eigen::Vector3d white = xyzFromChromaticity({row.number(0), row.number(1)});
    labDifference.add(lab(row.vector(2), white), row.vector(5));
    uvDifference.add(chromaticityUv(row.vector(2)), Eigen::Vector2d(row.number(8), row.number(9)));
  }
}

TEST(ColorimetryTest, DeltaE2000EqualsColourScience) {
  MaxDifference difference("deltaE2000", kOracleTolerance);
  for (const FixtureRow& row : readFixture("delta_e_2000.csv")) {
    difference.add(deltaE2000(row.vector(0), row.vector(3)), row.number(6));
  }
}

TEST(ColorimetryTest, DeltaE2000EqualsThePublishedPairs) {
  // The paper prints four decimals.
  MaxDifference difference("deltaE2000 of the published pairs", 5e-5);
  for (const FixtureRow& row : readFixture("sharma_2005.csv")) {
    difference.add(deltaE2000(row.vector(0), row.vector(3)), row.number(6));
    difference.add(deltaE2000(row.vector(3), row.vector(0)), row.number(6));
  }
}

TEST(ColorimetryTest, DeltaE2000OfOppositeHuesDoesNotHangOnTheLastBit) {
  const auto opposite = [](double degrees) {
    const double angle = degrees * 3.14159265358979323846 / 180;
    const Eigen::Vector3d colour(50, 20 * std::cos(angle), 20 * std::sin(angle));
    return deltaE2000(colour, {50, -colour[1], -colour[2]});
  };
  for (int i = 0; i < 360; ++i) {
    const double degrees = i / 2.0 + 0.25;
    // The difference of about 30 turns with the hue by less than 1 a degree; the wrong branch is off by more than 0.1.
    EXPECT_NEAR(opposite(degrees + 1e-6), opposite(degrees), 1e-4) << degrees;
  }
}

TEST(ColorimetryTest, Difference2000HasTheLengthOfDeltaE2000) {
  // A few square roots and one turn: rounding of differences up to 100.
  MaxDifference difference("difference2000", 1e-12);
  for (const char* name : {"delta_e_2000.csv", "sharma_2005.csv"}) {
    for (const FixtureRow& row : readFixture(name)) {
      difference.add(difference2000(row.vector(0), row.vector(3)).norm(), deltaE2000(row.vector(0), row.vector(3)));
    }
  }
}

TEST(ColorimetryTest, Difference2000IsSmoothAboutNeutral) {
  // Round a neutral target the chroma alone has a kink, and the hue turns; the vector goes by a and b.
  for (const Eigen::Vector3d& target : {Eigen::Vector3d(50, 0, 0), Eigen::Vector3d(50, 1e-9, -1e-9)}) {
    const Eigen::Vector3d right = difference2000(target, {50, 1e-4, 0});
    const Eigen::Vector3d left = difference2000(target, {50, -1e-4, 0});
    const Eigen::Vector3d up = difference2000(target, {50, 0, 1e-4});
    // The formula's own hue difference, 2 sqrt(C1 C2), is 8e-7 here; a kink would be as large as the difference itself.
    EXPECT_LT((right + left).norm(), 2e-6);
    EXPECT_NEAR(right[1], 1.5e-4, 1e-6);  // a is stretched by half where there is no chroma
    EXPECT_NEAR(up[2], 1e-4, 1e-6);
  }
}

TEST(ColorimetryTest, DeltaE2000OfEqualColoursIsZero) {
  EXPECT_EQ(deltaE2000({50, 20, -30}, {50, 20, -30}), 0);
  EXPECT_EQ(deltaE2000({0, 0, 0}, {0, 0, 0}), 0);
}

}  // namespace
}  // namespace metamer::spectral
