// SPDX-License-Identifier: Apache-2.0
#include "metamer/skin/skin_network.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "metamer/skin/skin_estimator.h"
#include "spectral/refusals.h"

namespace metamer::skin {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using spectral::MaxDifference;
using spectral::testLibrary;

using Loss = SkinNetwork::Loss;

spectral::RgbSpace spaceNamed(const char* name) {
  return testLibrary().colourSpace(name).linear;
}

class SkinNetworkTest : public testing::TestWithParam<Loss> {};

TEST_P(SkinNetworkTest, FindsMelaninAndBloodOfPeople) {
  const SkinNetwork network(testLibrary(), spaceNamed("Rec.709"), GetParam());
  const SkinPrior prior = SkinPrior::read(testLibrary());
  SkinCoordinates squares = SkinCoordinates::Zero();
  // People of another seed than those that it was trained on.
  const std::vector<SkinParameters> people = sampleSkins(prior, 300, 77);
  MaxDifference difference("round trip", 1e-6);
  for (const SkinParameters& skin : people) {
    const Vector3f colour = network.colours().rgb(skin).cast<float>();
    const SkinPixel found = network.estimate(colour);
    difference.add(network.colours().colour(found).cast<double>(), colour.cast<double>());
    squares +=
        (coordinatesOf(found.parameters()) - coordinatesOf(skin)).cwiseQuotient(prior.standardDeviation).cwiseAbs2();
  }
  const SkinCoordinates error = (squares / static_cast<double>(people.size())).cwiseSqrt();
  std::printf("[ in the prior's deviations ] melanin %.2f, blood %.2f, thickness %.2f, eumelanin %.2f, deoxy %.2f\n",
              error[0], error[1], error[2], error[3], error[4]);
  // As the estimator's test has it: known, and the prior's.
  EXPECT_LT(error[0], 0.25);
  EXPECT_LT(error[1], 0.3);
  EXPECT_LT(error[4], 0.75);
  EXPECT_GT(error[2], 0.5);
}

TEST_P(SkinNetworkTest, IsTheSameInEverySpace) {
  const SkinNetwork own(testLibrary(), spaceNamed("Rec.709"), GetParam());
  const SkinNetwork wide(testLibrary(), spaceNamed("ACEScg"), GetParam());
  MaxDifference difference("coordinates", 1e-5);
  for (const SkinParameters& skin : sampleSkins(own.colours().prior(), 40, 78)) {
    const SkinCoordinates here = coordinatesOf(own.estimate(own.colours().rgb(skin).cast<float>()).parameters());
    const SkinCoordinates there = coordinatesOf(wide.estimate(wide.colours().rgb(skin).cast<float>()).parameters());
    difference.add(here.cwiseQuotient(own.colours().prior().standardDeviation),
                   there.cwiseQuotient(own.colours().prior().standardDeviation));
  }
}

TEST_P(SkinNetworkTest, HoldsHardColours) {
  const SkinNetwork network(testLibrary(), spaceNamed("Rec.709"), GetParam());
  constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();
  for (const Vector3f& colour :
       {Vector3f(0, 0, 0), Vector3f(1, 1, 1), Vector3f(0.02F, 0.05F, 0.9F), Vector3f(0.05F, 1, 0.1F),
        Vector3f(0.9F, 0.02F, 0.05F), Vector3f(-0.1F, 0.5F, 0.3F), Vector3f(-1, -1, -1), Vector3f(3e38F, 2e38F, 1e38F),
        Vector3f(1e-30F, 2e-30F, 1e-30F), Vector3f(kNotANumber, 1, 1)}) {
    const SkinPixel pixel = network.estimate(colour);
    EXPECT_NO_THROW(requireSkin(pixel.parameters()));
    EXPECT_TRUE(std::isfinite(pixel.gain));
    const Vector3f back = network.colours().colour(pixel);
    if (colour.allFinite()) {
      EXPECT_LE((back - colour).cwiseAbs().maxCoeff(), 1e-6F * colour.cwiseAbs().maxCoeff());
    } else {
      EXPECT_FALSE(back.allFinite());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Losses, SkinNetworkTest, testing::Values(Loss::Rgb, Loss::Spectral));

TEST(SkinNetwork, DecodesItsSpectra) {
  const SkinNetwork network(testLibrary(), spaceNamed("Rec.709"), Loss::Spectral);
  double squares = 0;
  for (const SkinParameters& skin : sampleSkins(network.colours().prior(), 100, 79)) {
    const Eigen::VectorXd spectrum = network.decoded(skin);
    ASSERT_EQ(spectrum.size(), kSkinBands);
    squares += (spectrum - network.colours().albedo(skin)).squaredNorm() / (100 * kSkinBands);
  }
  // Decoders of a few thousand weights, trained by angles alone: a tenth of skin's own size.
  EXPECT_LT(std::sqrt(squares), 0.02);
  EXPECT_EQ(SkinNetwork(testLibrary(), spaceNamed("Rec.709"), Loss::Rgb).decoded({}).size(), 3);
  EXPECT_REFUSED("melanin '2'", network.decoded({2, 0.02, 90, 0.2, 0.4}));
}

TEST(SkinNetwork, RefusesWhatDoesNotFit) {
  const SkinNetwork network(testLibrary(), spaceNamed("Rec.709"), Loss::Spectral);
  std::vector<SkinPixel> pixels(2);
  const std::vector<float> rgb(6, 0.2F);
  EXPECT_TAKEN(network.estimate(rgb, pixels, 256));
  EXPECT_REFUSED("rgb '6'", network.estimate(rgb, std::span(pixels).subspan(1), 1));
  EXPECT_REFUSED("threads '0'", network.estimate(rgb, pixels, 0));
}

}  // namespace
}  // namespace metamer::skin
