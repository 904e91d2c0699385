// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/band_weights.h"

#include <gtest/gtest.h>

#include "sip/sip_fixture.h"

namespace metamer::sip {
namespace {

const std::vector<int> kBandCounts{kMinimumBandCount, 41, 81, 201, kDefaultBandCount, kConvergedBandCount};

TEST(BandWeightsTest, Centres) {
  for (const int bands : kBandCounts) {
    EXPECT_EQ(bandCentreNm(0, bands), 380.0);
    EXPECT_EQ(bandCentreNm(bands - 1, bands), 780.0);
  }
  EXPECT_EQ(bandCentreNm(40, 81), 580.0);
  EXPECT_EQ(bandCentreNm(20, kConvergedBandCount), 400.0);
}

TEST(BandWeightsTest, AreHatFunctionIntegrals) {
  const spectral::DomainSamples light = testLibrary().illuminant("HP1").onDomain();
  const auto curves = testLibrary().observer("CIE 1931 2").onDomain();
  for (const int bands : kBandCounts) {
    spectral::MaxDifference difference("weights of " + std::to_string(bands) + " bands", 1e-12);
    Eigen::Matrix3Xd expected = Eigen::Matrix3Xd::Zero(3, bands);
    const double width = 400.0 / (bands - 1);
    for (int i = 0; i < spectral::kDomainSize; ++i) {
      for (int b = 0; b < bands; ++b) {
        const double hat = std::max(0.0, 1.0 - std::abs(i - 400.0 * b / (bands - 1)) / width);
        expected.col(b) += hat * light[i] * curves.row(i).transpose();
      }
    }
    const Eigen::Matrix3Xd weights = bandWeights(light, curves, bands);
    ASSERT_EQ(weights.cols(), bands);
    const double size = expected.maxCoeff();
    difference.add(weights / size, expected / size);
  }
}

TEST(BandWeightsTest, RowsSumToThePerfectReflector) {
  for (const char* const name : {"D65", "HP1", "LPS", "LED-RGB1"}) {
    const spectral::DomainSamples light = testLibrary().illuminant(name).onDomain();
    const auto curves = testLibrary().observer("CIE 1931 2").onDomain();
    const Eigen::Vector3d white = curves.transpose() * light;
    for (const int bands : kBandCounts) {
      const Eigen::Vector3d sums = bandWeights(light, curves, bands).rowwise().sum();
      EXPECT_LE((sums - white).cwiseQuotient(white).cwiseAbs().maxCoeff(), 1e-12) << name << " " << bands;
    }
  }
}

TEST(BandWeightsTest, ConvergedBandsAreTheDomain) {
  const spectral::DomainSamples sample = samplesOf("colorchecker").front();
  EXPECT_EQ(atBandCentres(sample, kConvergedBandCount), Eigen::VectorXd(sample));
  const Eigen::VectorXd few = atBandCentres(sample, 81);
  for (int b = 0; b < 81; ++b) {
    EXPECT_EQ(few[b], sample[5 * b]);
  }
  // 400 nm do not divide by 6: between the domain's own samples, the mean of neighbours at a weight.
  const Eigen::VectorXd odd = atBandCentres(sample, 31);
  EXPECT_NEAR(odd[1], 2 * sample[13] / 3 + sample[14] / 3, 1e-12);
}

}  // namespace
}  // namespace metamer::sip
