// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/scene_cache.h"

#include <gtest/gtest.h>

#include "scenes/measured_seeds.h"
#include "sip/transform/transform_fixture.h"

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
  const Eigen::MatrixXd reflectances = onBands(samplesOf("colorchecker"), MeasuredSeeds::kNodeCount);
  const Eigen::VectorXd noise = Eigen::VectorXd::Constant(reflectances.cols(), 0.2);
  const auto first = cache.seeds(weights, reflectances, noise);
  EXPECT_EQ(cache.seeds(weights, reflectances, noise), first);
  // Another light, other samples, other noise, other bands.
  EXPECT_NE(cache.seeds(normalisedWeights("A", 41), reflectances, noise), first);
  EXPECT_NE(cache.seeds(weights, 0.5 * reflectances, noise), first);
  EXPECT_NE(cache.seeds(weights, reflectances.leftCols(9), noise.head(9)), first);
  EXPECT_NE(cache.seeds(weights, reflectances, 2.0 * noise), first);
  EXPECT_NE(cache.seeds(normalisedWeights("D65", 81), reflectances, noise), first);
  EXPECT_EQ(cache.seeds(weights, reflectances, noise), first);
  // The oldest goes, and what is still used elsewhere lives on.
  for (int i = 1; i <= 20; ++i) {
    cache.seeds(weights, reflectances, (1.0 + i) * noise);
  }
  EXPECT_NE(cache.seeds(weights, reflectances, noise), first);
  EXPECT_EQ(cache.seeds(weights, reflectances, noise)->solved, first->solved);
}

}  // namespace
}  // namespace metamer::sip
