// SPDX-License-Identifier: Apache-2.0
#include "integrator/sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "lights/alias_table.h"

namespace metamer::spectral_ref {
namespace {

TEST(SamplerTest, PointsAreStratifiedInEveryDimensionOfEverySet) {
  // 2^k points of an Owen-scrambled Sobol sequence lie one in each of 2^k equal intervals.
  constexpr std::uint32_t kPoints = 64;
  for (const std::uint32_t number : {0U, 1U, 5U}) {
    for (std::size_t d = 0; d < Sampler::kSetSize; ++d) {
      for (const std::uint32_t block : {0U, 3U}) {
        std::set<int> cells;
        for (std::uint32_t i = 0; i < kPoints; ++i) {
          cells.insert(static_cast<int>(Sampler(11, block * kPoints + i).set(number)[d] * kPoints));
        }
        EXPECT_EQ(cells.size(), kPoints) << "set " << number << " dimension " << d;
      }
    }
  }
}

TEST(SamplerTest, TheFirstTwoDimensionsAreANet) {
  // Every elementary rectangle of area 1/64 holds one of 64 points.
  for (int columns = 1; columns <= 64; columns *= 2) {
    std::set<int> cells;
    for (std::uint32_t i = 0; i < 64; ++i) {
      const Sampler::Set set = Sampler(99, i).set(0);
      const int rows = 64 / columns;
      cells.insert(static_cast<int>(set[0] * static_cast<float>(columns)) * rows +
                   static_cast<int>(set[1] * static_cast<float>(rows)));
    }
    EXPECT_EQ(cells.size(), 64U) << columns;
  }
}

TEST(SamplerTest, SequencesAndSetsAreApart) {
  // Correlation between the same dimension of two sequences, and of two sets: 4096 pairs, four standard errors.
  constexpr int kPairs = 4096;
  double sequences = 0;
  double sets = 0;
  for (std::uint32_t i = 0; i < kPairs; ++i) {
    const double a = static_cast<double>(Sampler(i, 0).set(0)[2]) - 0.5;
    sequences += a * (static_cast<double>(Sampler(i + 1, 0).set(0)[2]) - 0.5);
    sets += a * (static_cast<double>(Sampler(i, 0).set(1)[2]) - 0.5);
  }
  const double bound = 4.0 / 12.0 / std::sqrt(kPairs);
  EXPECT_LT(std::abs(sequences / kPairs), bound);
  EXPECT_LT(std::abs(sets / kPairs), bound);
}

TEST(AliasTableTest, FrequenciesFollowTheWeights) {
  const std::vector<double> weights = {0.0, 1.0, 2.5, 0.25, 6.25, 0.0};
  const AliasTable table(weights);
  // Evenly spread numbers: the counts are the probabilities up to one an interval of the table.
  constexpr std::uint32_t kDraws = 1U << 16U;
  std::vector<int> counts(weights.size());
  for (std::uint32_t i = 0; i < kDraws; ++i) {
    ++counts[table.sample((i << 16U) | 0x8000U)];
  }
  for (std::uint32_t i = 0; i < weights.size(); ++i) {
    EXPECT_NEAR(static_cast<double>(table.probability(i)), weights[i] / 10.0, 1e-7);
    EXPECT_NEAR(counts[i], weights[i] / 10.0 * kDraws, 8) << i;
  }
}

TEST(AliasTableTest, NoWeightAtAllIsUniform) {
  const AliasTable table({0.0, 0.0, 0.0, 0.0});
  for (std::uint32_t i = 0; i < 4; ++i) {
    EXPECT_FLOAT_EQ(table.probability(i), 0.25F);
    EXPECT_EQ(table.sample((i << 30U) + 1000), i);
  }
}

}  // namespace
}  // namespace metamer::spectral_ref
