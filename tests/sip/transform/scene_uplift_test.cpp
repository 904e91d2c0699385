// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/scene_uplift.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "metamer/sip/recipe.h"
#include "metamer/spectral/colorimetry.h"
#include "sip/transform/transform_fixture.h"

namespace metamer::sip {
namespace {

using Eigen::Vector3d;
using spectral::testLibrary;

const spectral::Uplift& upliftOf(const std::string& name) {
  static std::map<std::string, std::unique_ptr<spectral::Uplift>> built;
  std::unique_ptr<spectral::Uplift>& uplift = built[name];
  if (!uplift) {
    uplift = makeUplift(name, testLibrary());
  }
  return *uplift;
}

Eigen::VectorXd spectrumOf(const spectral::Uplift& uplift, const Vector3d& rgb) {
  Eigen::VectorXd spectrum(static_cast<Eigen::Index>(uplift.wavelengthsNm().size()));
  uplift.spectra({rgb.data(), 3}, {spectrum.data(), static_cast<std::size_t>(spectrum.size())});
  return spectrum;
}

const std::vector<std::string> kScenes = {"smooth", "natural", "skin"};
const std::vector<Vector3d> kColours = {{0.45, 0.27, 0.19}, {0.1, 0.6, 0.2}, {0.02, 0.05, 0.4}, {0.18, 0.18, 0.18}};

TEST(SceneUplift, MeetsTheColourUnderDaylight) {
  const spectral::Spectrum light = testLibrary().illuminant("D65");
  const spectral::Observer observer = testLibrary().observer("CIE 1931 2");
  for (const std::string& name : kScenes) {
    const spectral::Uplift& uplift = upliftOf(name);
    for (const Vector3d& rgb : kColours) {
      const Eigen::VectorXd spectrum = spectrumOf(uplift, rgb);
      const std::vector<double> values(spectrum.begin(), spectrum.end());
      const Vector3d xyz = spectral::tristimulus(
          {"r", spectral::SpectralQuantity::Reflectance, uplift.wavelengthsNm(), values}, light, observer);
      // The engine's weights are exact integrals of what is linear between the wavelengths, the library's sums of 1 nm.
      EXPECT_LT((xyz - uplift.xyzFromRgb() * rgb).norm(), 2e-4) << name << " " << rgb.transpose();
      EXPECT_GE(spectrum.minCoeff(), 0) << name << " " << rgb.transpose();
    }
    EXPECT_NEAR((uplift.xyzFromRgb() * Vector3d::Ones()).y(), 1, 1e-12);
  }
}

TEST(SceneUplift, IsWhatARecipesTransformTakes) {
  for (const std::string& name : kScenes) {
    const Recipe recipe = parseRecipe(
        "metamer: 1\nspace: Rec.709\ninput: {illuminant: D65}\noutput: {illuminant: D65}\n"
        "scene: {kind: " +
            name + "}\n",
        "recipe");
    const SpectralTransform transform(resolve(recipe, testLibrary()), 81);
    for (const Vector3d& rgb : kColours) {
      EXPECT_LT((spectrumOf(upliftOf(name), rgb) - transform.reflectance(rgb)).cwiseAbs().maxCoeff(), 1e-12) << name;
    }
  }
  // And they are three.
  const Vector3d skin = kColours[0];
  EXPECT_GT((spectrumOf(upliftOf("natural"), skin) - spectrumOf(upliftOf("smooth"), skin)).norm(), 0.05);
  EXPECT_GT((spectrumOf(upliftOf("natural"), skin) - spectrumOf(upliftOf("skin"), skin)).norm(), 0.01);
}

TEST(SceneUplift, ScenesAreToldFromPublishedMethods) {
  for (const std::string& name : upliftNames()) {
    const bool isScene = std::find(kScenes.begin(), kScenes.end(), name) != kScenes.end();
    EXPECT_EQ(isSceneUplift(name), isScene) << name;
    EXPECT_EQ(isSceneUplift(" " + name + " "), isScene) << name;
  }
  EXPECT_TRUE(isSceneUplift("Natural"));
}

TEST(SceneUplift, EveryColourHasItsOwnSpectrumAtAnyExposure) {
  std::vector<double> rgb;
  for (int i = 0; i < 150; ++i) {
    const double t = i / 150.0;
    rgb.insert(rgb.end(), {0.1 + 0.8 * t, 0.9 - 0.7 * t, 0.3 + 0.2 * std::sin(9 * t)});
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  rgb[3 * 70 + 1] = nan;
  const spectral::Uplift& uplift = upliftOf("natural");
  const std::size_t bands = uplift.wavelengthsNm().size();
  std::vector<double> together(150 * bands);
  uplift.spectra(rgb, together);
  for (std::size_t i = 0; i < 150; ++i) {
    const Vector3d colour(rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]);
    const Eigen::Map<const Eigen::VectorXd> own(&together[i * bands], static_cast<Eigen::Index>(bands));
    if (i == 70) {
      EXPECT_TRUE(own.array().isNaN().all());
      continue;
    }
    // Sums over columns round by where a column lies.
    EXPECT_LT((spectrumOf(uplift, colour) - own).cwiseAbs().maxCoeff(), 1e-15) << i;
    EXPECT_LT((spectrumOf(uplift, colour / 1024) * 1024 - own).cwiseAbs().maxCoeff(), 1e-15) << i;
  }
  EXPECT_EQ(spectrumOf(uplift, Vector3d::Zero()).cwiseAbs().maxCoeff(), 0);
}

TEST(SceneUplift, NamesAndWeights) {
  EXPECT_EQ(upliftNames().size(), spectral::upliftMethodNames().size() + 3);
  EXPECT_EQ(makeUplift(" Mallett ", testLibrary())->wavelengthsNm().size(), 81U);
  EXPECT_THROW(makeUplift("dataset", testLibrary()), spectral::InputError);
  EXPECT_THROW(makeUplift("smooth", testLibrary(), spectral::UpliftWeights::Ones(81, 3)), spectral::InputError);
}

}  // namespace
}  // namespace metamer::sip
