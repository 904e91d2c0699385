// SPDX-License-Identifier: Apache-2.0
// Light cuts and choices by place against the probabilities that they state, and reservoirs against the integrals that
// they stand for.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>

#include "integrator/reservoir.h"
#include "lights/light_choice.h"
#include "lights/light_cuts.h"
#include "materials/material_table.h"
#include "spectral_ref/scene_fixture.h"
#include "statistical/chi_square.h"
#include "wavelengths/wavelength_sampling.h"

namespace metamer::spectral_ref {
namespace {

constexpr double kSignificance = 1e-4;

/// 150 lamps of three spectra about the origin, a ball, a point, a spot, a small picture of a sky.
std::string lamps() {
  std::string text =
      "metamer_scene: 1\n"
      "spectra: {warm: {wavelengths: [400, 700], values: [0.1, 3]}, cold: {wavelengths: [400, 700], values: [3, "
      "0.1]}}\n"
      "shapes:\n"
      "  - sphere: {center: [3, 0.5, 1], radius: 0.5}\n    emission: cold\n";
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 150; ++i) {
    std::array<double, 5> number;
    for (double& one : number) {
      one = unit(engine);
    }
    text += "  - rectangle: {center: [" + std::to_string(4.0 * number[0]) + ", " + std::to_string(4.0 * number[1]) +
            ", " + std::to_string(1.5 + number[2]) + "], half_u: [0, 0.1, " + std::to_string(0.05 * number[3]) +
            "], half_v: [0.1, 0, " + std::to_string(0.05 * number[4]) + "]}\n    emission: " +
            (i % 3 == 0   ? "warm"
             : i % 3 == 1 ? "cold"
                          : "1") +
            "\n";
  }
  return text +
         "lights:\n"
         "  - environment: {emission: 0.05}\n"
         "  - point: {position: [0.5, 0.5, 0.8], intensity: warm}\n"
         "  - spot: {position: [0, 0, 3], target: [0, 0, 0], intensity: cold}\n";
}

class ResamplingTest : public testing::Test {
 protected:
  ResamplingTest()
      : scene(sceneOf(lamps())),
        shapes(scene),
        spectra(scene),
        lights(scene, shapes),
        bounds(lights.bounds(scene)),
        tree(bounds),
        cuts(tree, 2) {
    cuts.build(0, {{Vec3(0.2F, 0.1F, 0.0F), Vec3::UnitZ()}, {Vec3(1.0F, 0.0F, 0.0F), Vec3(0.0F, 0.6F, 0.8F)}});
    cuts.build(1, {});
  }

  float next() { return std::min(m_unit(m_engine), 0x1.fffffep-1F); }
  std::uint32_t bits() { return static_cast<std::uint32_t>(m_engine()); }

  ReservoirDomain<4> domain(const Vec3& place, const Vec3& normal, float u) const {
    ReservoirDomain<4> result;
    const WavelengthSet<4> set = sampleWavelengths<4>(UniformWavelengths(), u);
    for (std::size_t k = 0; k < 4; ++k) {
      result.cell[k] = static_cast<std::uint16_t>(set.cell[k]);
      result.factor[k] = 0.2F + 0.3F * static_cast<float>(k);
    }
    result.place = {place.x(), place.y(), place.z()};
    result.up = {normal.x(), normal.y(), normal.z()};
    return result;
  }

  Scene scene;
  EmbreeScene shapes;
  SpectrumTables spectra;
  LightTable lights;
  std::vector<LightBounds> bounds;
  LightTree tree;
  LightCuts cuts;

 private:
  std::mt19937 m_engine{77};
  std::uniform_real_distribution<float> m_unit{0.0F, 1.0F};
};

TEST_F(ResamplingTest, LightsAreChosenAsOftenAsStatedAndNoneNever) {
  constexpr int kDraws = 400000;
  for (const std::size_t block : {std::size_t{0}, std::size_t{1}}) {
    std::vector<double> counts(bounds.size());
    std::vector<double> expected(bounds.size());
    for (int i = 0; i < kDraws; ++i) {
      const LightCuts::Choice choice = cuts.choose(block, bits());
      counts[choice.light] += 1;
      ASSERT_EQ(choice.probability, cuts.probability(block, choice.light));
    }
    for (std::uint32_t light = 0; light < bounds.size(); ++light) {
      const float probability = cuts.probability(block, light);
      ASSERT_GT(probability, 0.0F) << light;
      expected[light] = kDraws * static_cast<double>(probability);
    }
    // 32-bit chances and float probabilities: relative errors of 1e-7 a light.
    EXPECT_NEAR(std::accumulate(expected.begin(), expected.end(), 0.0), kDraws, 1e-5 * kDraws);
    EXPECT_GT(chiSquareProbability(counts, expected), kSignificance) << block;
  }
}

TEST_F(ResamplingTest, TheExtremeNumbersChooseTheFirstAndTheLast) {
  EXPECT_EQ(cuts.choose(0, 0).light, tree.lightAt(0));
  EXPECT_EQ(cuts.choose(0, 0xffffffffU).light, tree.lightAt(static_cast<std::uint32_t>(tree.lightCount()) - 1));
}

TEST_F(ResamplingTest, EveryNodeIsImportantWhereItsLightsAre) {
  for (int i = 0; i < 20000; ++i) {
    const auto light = static_cast<std::uint32_t>(next() * static_cast<float>(bounds.size()));
    // In braces, so that numbers are drawn in the order they stand in.
    const Vec3 place{6.0F * next() - 3.0F, 6.0F * next() - 3.0F, 2.0F * next()};
    const Vec3 normal = Vec3{next() - 0.5F, next() - 0.5F, next() - 0.5F}.normalized();
    const LightSample seen = lights.located({light, next(), next()}, place);
    if (!(seen.pdf > 0.0F) || !(seen.direction.dot(normal) > 1e-4F)) {
      continue;
    }
    const std::uint32_t position = tree.positionOf(light);
    for (std::uint32_t node = 0;;) {
      const LightTree::Node& here = tree.node(node);
      // A spot gives nothing outside its cone, but is taken to.
      ASSERT_GT(LightTree::importance(here, place, normal), 0.0F) << "light " << light << ", node " << node;
      if (here.right == 0) {
        break;
      }
      node = position < tree.node(node + 1).end ? node + 1 : here.right;
    }
  }
}

TEST_F(ResamplingTest, APointDrawsLightsAsOftenAsItStates) {
  const LightChoice choice(lights, &tree);
  const std::array<LitPoint, 4> points = {{{Vec3(0.2F, 0.1F, 0.0F), Vec3::UnitZ(), false},
                                           {Vec3(1.0F, 0.0F, 1.2F), Vec3(0.6F, 0.0F, -0.8F), false},
                                           {Vec3(-2.0F, 1.0F, 1.0F), Vec3::UnitY(), true},
                                           // Below everything and turned away from it: the sky's lower half is left.
                                           {Vec3(0.0F, 0.0F, -9.0F), -Vec3::UnitZ(), false}}};
  constexpr int kDraws = 200000;
  for (const LitPoint& point : points) {
    std::vector<double> counts(bounds.size() + 1);
    std::vector<double> expected(bounds.size() + 1);
    for (int i = 0; i < kDraws; ++i) {
      const LightChoice::Choice drawn = choice.choose(point, bits());
      if (!(drawn.probability > 0.0F)) {
        counts.back() += 1;
        continue;
      }
      counts[drawn.entry] += 1;
      ASSERT_EQ(drawn.probability, choice.probability(point, drawn.entry));
    }
    expected.back() = kDraws;
    for (std::uint32_t light = 0; light < bounds.size(); ++light) {
      const float probability = choice.probability(point, light);
      ASSERT_GT(probability, 0.0F) << light;
      expected[light] = kDraws * static_cast<double>(probability);
      expected.back() -= expected[light];
    }
    EXPECT_GT(expected.back(), -1e-5 * kDraws);
    expected.back() = std::max(expected.back(), 0.0);
    EXPECT_GT(chiSquareProbability(counts, expected), kSignificance) << point.place.transpose();
  }
}

TEST_F(ResamplingTest, PointsTogetherDrawWhatEachDrawsAlone) {
  const LightChoice byPlace(lights, &tree);
  const LightChoice byPower(lights, nullptr);
  for (int i = 0; i < 2000; ++i) {
    std::array<LitPoint, LightChoice::kMostTogether> points;
    std::array<std::uint32_t, LightChoice::kMostTogether> numbers{};
    std::array<LightChoice::Choice, LightChoice::kMostTogether> drawn;
    for (std::size_t k = 0; k < points.size(); ++k) {
      points[k].place = Vec3{6.0F * next() - 3.0F, 6.0F * next() - 3.0F, 2.0F * next()};
      points[k].normal = Vec3{next() - 0.5F, next() - 0.5F, next() - 0.5F}.normalized();
      numbers[k] = bits();
    }
    for (const LightChoice* choice : {&byPlace, &byPower}) {
      choice->choose(points, numbers, drawn);
      for (std::size_t k = 0; k < points.size(); ++k) {
        const LightChoice::Choice alone = choice->choose(points[k], numbers[k]);
        ASSERT_EQ(drawn[k].entry, alone.entry);
        ASSERT_EQ(drawn[k].probability, alone.probability);
      }
    }
  }
}

TEST_F(ResamplingTest, BranchesLeadToEveryLightThatAPointSees) {
  const LightBranches branches(tree);
  int seenFromBehind = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto light = static_cast<std::uint32_t>(next() * static_cast<float>(bounds.size()));
    const Vec3 place{6.0F * next() - 3.0F, 6.0F * next() - 3.0F, 2.0F * next()};
    const Vec3 normal = Vec3{next() - 0.5F, next() - 0.5F, next() - 0.5F}.normalized();
    const LightSample seen = lights.located({light, next(), next()}, place);
    const float cosine = seen.direction.dot(normal);
    if (!(seen.pdf > 0.0F) || std::abs(cosine) < 1e-4F) {
      continue;
    }
    const std::uint32_t position = tree.positionOf(light);
    ASSERT_GT(branches.leafOf({place, normal, true}, position).probability, 0.0F) << light;
    if (cosine > 0.0F) {
      ASSERT_GT(branches.leafOf({place, normal, false}, position).probability, 0.0F) << light;
    } else {
      ++seenFromBehind;
    }
  }
  EXPECT_GT(seenFromBehind, 1000);
}

TEST_F(ResamplingTest, ALampThatIsCloseIsDrawnMoreThanItsPowerSays) {
  const LightChoice byPlace(lights, &tree);
  const LightChoice byPower(lights, nullptr);
  constexpr std::uint32_t kLamp = 10;  // one of the rectangles
  const LightBounds& lamp = bounds[kLamp];
  const LitPoint point{0.5F * (lamp.least + lamp.most) + 0.1F * lamp.axis, -lamp.axis, false};
  EXPECT_GT(byPlace.probability(point, kLamp), 10.0F * byPower.probability(point, kLamp));
}

/// Sums of target times contribution over many chains, against the integral of the target by light sampling: the
/// expectation of f W for f = p-hat, and for f = p-hat on the lights of even number alone.
TEST_F(ResamplingTest, ReservoirsStandForTheirIntegral) {
  const ReservoirSampler<4> sampler(lights, spectra, cuts);
  const std::array<ReservoirDomain<4>, 2> domains = {domain(Vec3(0.2F, 0.1F, 0.0F), Vec3::UnitZ(), 0.3F),
                                                     domain(Vec3(0.6F, -0.1F, 0.0F), Vec3(0.0F, 0.1F, 0.995F), 0.8F)};
  constexpr int kChains = 60000;
  std::array<double, 2> sum{};
  std::array<double, 2> squares{};
  std::array<double, 2> exact{};
  std::array<double, 2> exactSquares{};
  for (int i = 0; i < kChains; ++i) {
    const auto fresh = [&](std::size_t d) {
      const Sampler numbers(bits(), 0);
      return sampler.fresh(domains[d], numbers.candidates(7, ReservoirSampler<4>::kLog2Candidates), next());
    };
    Reservoir<4> own = fresh(0);
    const Reservoir<4> other = fresh(1);
    sampler.merge(own, other, 2.0F, next());
    Reservoir<4> again = fresh(1);
    const Reservoir<4> first = fresh(0);
    sampler.merge(again, first, 1.0F, next());
    sampler.merge(own, again, 3.0F, next());
    const double value = static_cast<double>(own.contribution) * static_cast<double>(own.target);
    ASSERT_FLOAT_EQ(own.contribution > 0.0F ? sampler.target(own.point, own.domain) : 0.0F, own.target);
    for (std::size_t part = 0; part < 2; ++part) {
      const double counted = part == 0 || own.point.entry % 2 == 0 ? value : 0.0;
      sum[part] += counted;
      squares[part] += counted * counted;
    }
    // The integral: lights uniformly, several at a time.
    for (int k = 0; k < 16; ++k) {
      const auto light = static_cast<std::uint32_t>(next() * static_cast<float>(bounds.size()));
      const double term =
          static_cast<double>(bounds.size()) * static_cast<double>(sampler.target({light, next(), next()}, domains[0]));
      for (std::size_t part = 0; part < 2; ++part) {
        const double counted = part == 0 || light % 2 == 0 ? term : 0.0;
        exact[part] += counted / 16;
        exactSquares[part] += counted * counted / 256;
      }
    }
  }
  for (std::size_t part = 0; part < 2; ++part) {
    const double z = (sum[part] - exact[part]) / std::sqrt(squares[part] + exactSquares[part]);
    EXPECT_GT(sidakProbability(z, 2), kSignificance) << part << ": " << sum[part] / exact[part];
    std::printf("reservoirs, part %zu: %.4f of the integral, z %+.2f\n", part, sum[part] / exact[part], z);
  }
}

TEST(LightTreeTest, LightsThatShareALeafAreToldApartByIntensity) {
  // More lights than leaves, in a row; every third one shines three times as much.
  constexpr std::uint32_t kCount = 3 * LightBranches::kMostLeaves / 2;
  std::vector<LightBounds> row(kCount);
  for (std::uint32_t i = 0; i < kCount; ++i) {
    row[i].least = Vec3(static_cast<float>(i), 0.0F, 1.0F);
    row[i].most = row[i].least + Vec3(0.5F, 0.5F, 0.0F);
    row[i].axis = -Vec3::UnitZ();
    row[i].intensity = i % 3 == 0 ? 3.0F : 1.0F;
  }
  const LightTree tree(row);
  const LightBranches branches(tree);
  const LitPoint point{Vec3(5000.0F, 0.0F, 0.0F), Vec3::UnitZ(), false};
  double sum = 0;
  std::uint32_t leaves = 0;
  for (std::uint32_t position = 0; position < kCount;) {
    const LightBranches::Leaf leaf = branches.leafOf(point, position);
    ASSERT_EQ(leaf.begin, position);
    sum += static_cast<double>(leaf.probability);
    position = leaf.end;
    ++leaves;
  }
  EXPECT_NEAR(sum, 1.0, 1e-4);
  EXPECT_GT(leaves, kCount / 4);
  EXPECT_LE(leaves, 2 * LightBranches::kMostLeaves);
}

TEST(LightTreeTest, LightsThatAllShineNothing) {
  std::vector<LightBounds> dark(3);
  const LightTree tree(dark);
  const LitPoint point;
  LightBranches::Leaf leaf{0, 0, 1.0F, 0.5};
  LightBranches(tree).descend({&point, 1}, {&leaf, 1});
  EXPECT_EQ(leaf.probability, 0.0F);
  LightCuts cuts(tree, 1);
  cuts.build(0, {{Vec3::Zero(), Vec3::UnitZ()}});
  for (const std::uint32_t number : {0U, 1U << 31U, 0xffffffffU}) {
    EXPECT_GT(cuts.choose(0, number).probability, 0.0F);
  }
}

}  // namespace
}  // namespace metamer::spectral_ref
