// SPDX-License-Identifier: Apache-2.0
#include "metamer/skin/skin_prior.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>

#include "spectral/fixture.h"

namespace metamer::skin {
namespace {

using spectral::testLibrary;

TEST(SkinPrior, DrawsWhatItSays) {
  const SkinPrior prior = SkinPrior::read(testLibrary());
  constexpr int kCount = 20'000;
  SkinCoordinates sum = SkinCoordinates::Zero();
  SkinCoordinates squares = SkinCoordinates::Zero();
  int atBorder = 0;
  for (const SkinParameters& skin : sampleSkins(prior, kCount, 1)) {
    ASSERT_NO_THROW(requireSkin(skin));
    const SkinCoordinates at = coordinatesOf(skin);
    sum += at;
    squares += at.cwiseProduct(at);
    atBorder += skin.eumelanin == 0.001 ? 1 : 0;
  }
  const SkinCoordinates mean = sum / kCount;
  // Melanin, blood and thickness are hardly cut; four standard errors of the mean.
  for (const Eigen::Index i : {0, 1, 2}) {
    EXPECT_NEAR(mean[i], prior.mean[i], 4 * prior.standardDeviation[i] / std::sqrt(kCount)) << i;
    const double deviation = std::sqrt(squares[i] / kCount - mean[i] * mean[i]);
    EXPECT_NEAR(deviation, prior.standardDeviation[i], 0.03 * prior.standardDeviation[i]) << i;
  }
  // A normal distribution of mean 0.1775 and deviation 0.3003 is below 0.001 with a probability of 0.278.
  EXPECT_NEAR(atBorder / static_cast<double>(kCount), 0.278, 0.013);
}

TEST(SkinPrior, HasTheShareOfEumelaninOfTheCheckedInSkins) {
  // Their parameters by least squares of an independent NumPy form of the model, phi_m as eumelanin's share. The table
  // has four digits, its makers' model another number of directions.
  const SkinPrior prior = SkinPrior::read(testLibrary());
  const spectral::ReflectanceSet published = testLibrary().reflectances("model skins");
  ASSERT_EQ(published.samples.size(), 100U);
  const SkinModel model(testLibrary());
  const std::array<std::pair<std::size_t, SkinParameters>, 3> fitted = {{
      {0, {0.0381827, 0.0126900, 85.1476, 0.00120581, 0.395000}},
      {5, {0.0288486, 0.0174336, 136.885, 0.146005, 0.397211}},
      {17, {0.0251637, 0.0267468, 77.4395, 0.399734, 0.518813}},
  }};
  for (const auto& [index, skin] : fitted) {
    const SkinSpectrum albedo = repaired(model.albedo(skin), prior);
    for (int band = 0; band < kSkinBands; ++band) {
      EXPECT_NEAR(albedo[band], published.samples[index].at(380 + 10 * band), 3e-4);
    }
  }
}

TEST(SkinPrior, MakesVirtualSkins) {
  const std::vector<spectral::Spectrum> skins = virtualSkins(testLibrary(), 50, 9);
  ASSERT_EQ(skins.size(), 50U);
  const std::vector<spectral::Spectrum> again = virtualSkins(testLibrary(), 50, 9);
  for (std::size_t i = 0; i < skins.size(); ++i) {
    EXPECT_EQ(skins[i].values(), again[i].values());
    EXPECT_GT(skins[i].at(700), skins[i].at(420)) << i;
  }
  EXPECT_NE(skins[0].values(), virtualSkins(testLibrary(), 1, 10)[0].values());
}

}  // namespace
}  // namespace metamer::skin
