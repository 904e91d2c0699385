// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/scene_cache.h"

#include <gtest/gtest.h>

#include "sip/transform/transform_fixture.h"
#include "transform/recovery.h"

namespace metamer::sip {
namespace {

TEST(SceneCacheTest, TransformsAreTheSameWithIt) {
  SceneCache cache;
  for (const auto& pair : {lightPairs()[1], lightPairs()[3], lightPairs()[1]}) {
    const TransformSpec spec = naturalSpecOf(pair.first, pair.second);
    const SpectralTransform alone(spec, 41);
    const SpectralTransform held(spec, 41, &cache);
    for (const Eigen::Vector3d& colour : colours(50)) {
      EXPECT_EQ(held.apply(colour), alone.apply(colour));
    }
  }
}

TEST(SceneCacheTest, HoldsWhatIsAskedForAgainAndNothingElse) {
  SceneCache cache;
  const Eigen::Matrix3Xd weights = normalisedWeights("D65", 41);
  ReferenceScene scene{ReferenceScene::Kind::Natural, samplesOf("colorchecker")};
  const auto first = cache.recovery(weights, 0.0, scene);
  EXPECT_EQ(cache.recovery(weights, 0.0, scene), first);
  // Another light, relaxation, scene, set, other bands.
  EXPECT_NE(cache.recovery(normalisedWeights("A", 41), 0.0, scene), first);
  EXPECT_NE(cache.recovery(weights, 10.0, scene), first);
  EXPECT_EQ(cache.recovery(weights, 0.0, scene), first);
  EXPECT_NE(cache.recovery(weights, 0.0, {ReferenceScene::Kind::Smooth, {}}), first);
  ReferenceScene fewer = scene;
  fewer.samples.pop_back();
  EXPECT_NE(cache.recovery(weights, 0.0, fewer), first);
  EXPECT_NE(cache.recovery(normalisedWeights("D65", 81), 0.0, scene), first);
  EXPECT_EQ(cache.recovery(weights, 0.0, scene), first);
  // The oldest goes, and what is still used elsewhere lives on.
  for (int i = 1; i <= 4; ++i) {
    cache.recovery(weights, i, scene);
  }
  const auto again = cache.recovery(weights, 0.0, scene);
  EXPECT_NE(again, first);
  const Eigen::Matrix3Xd grey = Eigen::Matrix3Xd::Constant(3, 1, 0.18);
  EXPECT_EQ(again->spectra(grey), first->spectra(grey));
}

}  // namespace
}  // namespace metamer::sip
