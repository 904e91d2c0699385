// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/spectral_similarity_index.h"

#include <gtest/gtest.h>

#include "spectral/fixture.h"

namespace metamer::spectral {
namespace {

TEST(SpectralSimilarityIndexTest, EqualsColourScience) {
  // The same sums in another order. The project asks for 1e-6.
  MaxDifference difference("spectral similarity index", 1e-6);
  for (const FixtureRow& row : readFixture("spectral_similarity.csv")) {
    const Spectrum light = testLibrary().illuminant(row.text(0));
    const Spectrum reference = testLibrary().illuminant(row.text(1));
    difference.add(spectralSimilarityIndex(light, reference, false), row.number(2));
    EXPECT_EQ(spectralSimilarityIndex(light, reference), row.number(3)) << row.text(0) << " " << row.text(1);
  }
}

TEST(SpectralSimilarityIndexTest, ScaleDoesNotCount) {
  const Spectrum lamp = testLibrary().illuminant("FL11");
  std::vector<double> brighter = lamp.values();
  for (double& value : brighter) {
    value *= 7;
  }
  const Spectrum scaled("scaled", lamp.quantity(), lamp.wavelengthsNm(), brighter);
  // Rounding of the scaling.
  EXPECT_NEAR(spectralSimilarityIndex(scaled, lamp, false), 100, 1e-10);
}

TEST(SpectralSimilarityIndexTest, DarkLightIsFinite) {
  const Spectrum dark("dark", SpectralQuantity::SpectralPowerDistribution, {380, 780}, {0, 0});
  EXPECT_TRUE(std::isfinite(spectralSimilarityIndex(dark, testLibrary().illuminant("A"), false)));
  EXPECT_TRUE(std::isfinite(spectralSimilarityIndex(testLibrary().illuminant("A"), dark, false)));
}

}  // namespace
}  // namespace metamer::spectral
