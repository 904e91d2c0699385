// SPDX-License-Identifier: Apache-2.0
// Every sampler against the density that it states: wavelengths, lights, BSDFs. And BSDFs against energy and
// reciprocity.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "film/film_sensor.h"
#include "lights/light_table.h"
#include "materials/material_table.h"
#include "spectral_ref/scene_fixture.h"
#include "statistical/chi_square.h"
#include "wavelengths/wavelength_guide.h"
#include "wavelengths/wavelength_sampling.h"

namespace metamer::spectral_ref {
namespace {

constexpr double kSignificance = 1e-4;

class Random {
 public:
  float next() { return std::min(m_unit(m_engine), 0x1.fffffep-1F); }
  std::uint32_t bits() { return static_cast<std::uint32_t>(m_engine()); }

 private:
  std::mt19937 m_engine{12345};
  std::uniform_real_distribution<float> m_unit{0.0F, 1.0F};
};

WavelengthSet<4> someWavelengths() {
  return sampleWavelengths<4>(UniformWavelengths(), 0.1F);
}

/// Each lane's wavelengths against a density by cell, which must be one, nowhere below `least`, and what weights say.
template <typename Distribution>
void expectLanesFollow(const Distribution& distribution, double least, const std::string& what,
                       Spread spread = Spread::Lanes) {
  std::vector<double> expected(kCells);
  double total = 0;
  for (std::int32_t cell = 0; cell < kCells; ++cell) {
    const auto density = static_cast<double>(distribution.density(cell));
    ASSERT_GE(density, 0.99 * least / kCells) << what << " cell " << cell;
    expected[static_cast<std::size_t>(cell)] = density;
    total += density;
  }
  EXPECT_NEAR(total, 1.0, 1e-4) << what;
  constexpr int kDraws = 200000;
  for (double& value : expected) {
    value *= kDraws / total;
  }
  Random random;
  std::array<std::vector<double>, 4> counts;
  counts.fill(std::vector<double>(kCells));
  for (int i = 0; i < kDraws; ++i) {
    const auto set = sampleWavelengths<4>(distribution, random.next(), spread);
    for (int lane = 0; lane < 4; ++lane) {
      const std::int32_t cell = set.cell[static_cast<std::size_t>(lane)];
      counts[static_cast<std::size_t>(lane)][static_cast<std::size_t>(cell)] += 1;
      ASSERT_NEAR(set.nm[lane], 380.0F + static_cast<float>(cell), 0.501F);
      ASSERT_NEAR(set.weight[lane] * 4.0F * distribution.density(cell), 1.0F, 1e-3F);
    }
  }
  for (std::size_t lane = 0; lane < 4; ++lane) {
    EXPECT_GT(chiSquareProbability(counts[lane], expected), kSignificance) << what << " lane " << lane;
  }
}

TEST(WavelengthDensityTest, EveryLaneFollowsTheTable) {
  expectLanesFollow(WavelengthTable(spectral::DomainSamples::Zero()), 1.0, "nothing known");
  spectral::DomainSamples spiky = spectral::DomainSamples::Constant(0.05);
  spiky[0] = 3.0;
  spiky[166] = 20.0;
  spiky.tail(100).setZero();
  spiky[400] = 1.0;
  expectLanesFollow(WavelengthTable(spiky), WavelengthTable::kDefensive, "spiky");
  expectLanesFollow(WavelengthTable(spiky), WavelengthTable::kDefensive, "spiky, by hero", Spread::Hero);
}

/// Teaches a guide and looks at what it draws from. @param step  pixels a block is wide
void expectFollowsWhatIsLearnt(const spectral::DomainSamples& lamp, int step) {
  const int side = 16 * step;
  WavelengthGuide guide(side, side, 4, lamp);
  Random random;
  WavelengthGuide::Spectrum spectrum;
  // A line and a slope; in one corner red light alone; black pixels in another.
  int learnt = 0;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      if (!guide.isLearntFrom(x, y)) {
        continue;
      }
      ++learnt;
      const bool isRed = std::max(x, y) < 4 * step;
      const bool isBlack = std::min(x, y) > 11 * step;
      const auto set = sampleWavelengths<4>(guide.picture(), random.next());
      Lanes<4> worth;
      for (int k = 0; k < 4; ++k) {
        const int cell = set.cell[static_cast<std::size_t>(k)];
        const float usual = (std::abs(cell - 166) < 3 ? 40.0F : 0.0F) + (cell < 350 ? 1.0F : 0.0F);
        worth[k] = isBlack ? 0.0F : set.weight[k] * (isRed ? (cell > 350 ? 1.0F : 0.0F) : usual);
      }
      guide.learn<4>(guide.blockOf(x, y), set, worth, spectrum);
    }
  }
  EXPECT_EQ(learnt, 16 * 16);
  guide.add(spectrum);
  guide.build();
  EXPECT_FALSE(guide.isUniform());
  expectLanesFollow(guide.picture(), WavelengthTable::kDefensive, "picture");
  const std::size_t black = guide.blockOf(side - 1, side - 1);
  for (const std::size_t block : {guide.blockOf(0, 0), guide.blockOf(1, 1)}) {
    ASSERT_TRUE(guide.hasOwn(block)) << block;
    expectLanesFollow(guide.own(block),
                      WavelengthTable::kDefensive * static_cast<double>(WavelengthGuide::kPictureShare),
                      "block " + std::to_string(block));
    // Most of what is learnt there is red.
    EXPECT_GT(guide.density(block).tail(50).sum(), 0.5) << block;
    EXPECT_LT(guide.density(black).tail(50).sum(), 0.2);
  }
  EXPECT_FALSE(guide.hasOwn(black));
  EXPECT_FALSE(guide.hasOwn(guide.blockOf(side / 2, side / 2)));
}

TEST(WavelengthDensityTest, EveryLaneFollowsTheGuideAndNoDensityIsZero) {
  spectral::DomainSamples lamp = spectral::DomainSamples::LinSpaced(0.2, 1.0);
  expectFollowsWhatIsLearnt(lamp, 2);
  lamp[166] = 100.0;
  expectFollowsWhatIsLearnt(lamp, 1);
}

TEST(WavelengthDensityTest, EvenLightStaysUniform) {
  const spectral::DomainSamples even = spectral::DomainSamples::LinSpaced(0.5, 1.0);
  WavelengthGuide guide(8, 8, 4, even);
  guide.build();
  EXPECT_TRUE(guide.isUniform());
  for (std::int32_t cell = 0; cell < kCells; ++cell) {
    EXPECT_NEAR(guide.picture().density(cell) * kCells, 1.0F, 1e-3F) << cell;  // as exactly as u is spaced
  }
}

/// Directions by cells of equal solid angle.
constexpr int kColumns = 24;
constexpr int kRows = 16;
constexpr std::size_t kDirectionCells = std::size_t{kColumns} * kRows;
std::size_t cellOf(const Vec3& d) {
  float phi = std::atan2(d.y(), d.x()) / (2.0F * kPi);
  phi -= std::floor(phi);
  const int column = std::min(static_cast<int>(phi * kColumns), kColumns - 1);
  const int row = std::clamp(static_cast<int>((d.z() + 1.0F) * 0.5F * kRows), 0, kRows - 1);
  return static_cast<std::size_t>(row) * kColumns + static_cast<std::size_t>(column);
}
template <typename Density>
std::vector<double> expectedIn(const Density& density, double draws) {
  constexpr int kFine = 48;
  std::vector<double> expected(kDirectionCells);
  for (std::size_t cell = 0; cell < expected.size(); ++cell) {
    const std::size_t row = cell / kColumns;
    double sum = 0;
    for (int i = 0; i < kFine; ++i) {
      for (int j = 0; j < kFine; ++j) {
        const double z = ((static_cast<double>(row) + (i + 0.5) / kFine) / kRows) * 2.0 - 1.0;
        const double phi = 2.0 * M_PI * (static_cast<double>(cell % kColumns) + (j + 0.5) / kFine) / kColumns;
        const double sine = std::sqrt(1.0 - z * z);
        sum += density(Vec3(static_cast<float>(sine * std::cos(phi)), static_cast<float>(sine * std::sin(phi)),
                            static_cast<float>(z)));
      }
    }
    expected[cell] = draws * sum / (kFine * kFine) * 4.0 * M_PI / kDirectionCells;
  }
  return expected;
}

class BsdfTest : public testing::TestWithParam<const char*> {
 protected:
  BsdfTest()
      : scene(sceneOf(std::string("metamer_scene: 1\nshapes:\n  - sphere: {center: [0, 0, 0], radius: 1}\n    ") +
                      GetParam() + "\n")),
        spectra(scene),
        materials(scene) {}

  Bsdf<4, true> bsdf() const { return materials.bsdf<4, true>(0, spectra, someWavelengths()); }

  Scene scene;
  SpectrumTables spectra;
  MaterialTable materials;
  Random random;
};

TEST_P(BsdfTest, SamplesFollowTheirDensity) {
  for (const Vec3& given : {Vec3(0.3F, 0.2F, 0.9F), Vec3(0.9F, 0.1F, 0.25F), Vec3(0.4F, 0.0F, -0.8F)}) {
    const Vec3 out = given.normalized();
    if (bsdf().isBlack(out)) {
      continue;
    }
    constexpr int kDraws = 200000;
    std::vector<double> counts(kDirectionCells);
    double found = 0;
    for (int i = 0; i < kDraws; ++i) {
      const float u = random.next();
      const float v = random.next();
      const auto sample = bsdf().sample(out, u, v, [&] { return random.next(); });
      if (sample.pdf[0] > 0.0F) {
        counts[cellOf(sample.direction)] += 1;
        found += 1;
      }
    }
    const auto expected =
        expectedIn([&](const Vec3& in) { return static_cast<double>(bsdf().evaluate(out, in).pdf[0]); }, kDraws);
    double total = 0;
    for (const double value : expected) {
      total += value;
    }
    // What is lost in sampling is missing from the density as well.
    EXPECT_NEAR(found / total, 1.0, 5e-3) << GetParam() << " from " << out.transpose();
    EXPECT_GT(chiSquareProbability(counts, expected), kSignificance) << GetParam() << " from " << out.transpose();
  }
}

TEST_P(BsdfTest, EnergyAndReciprocity) {
  const auto wavelengths = someWavelengths();
  for (int i = 0; i < 200; ++i) {
    const auto direction = [&] {
      const float u = random.next();
      const float v = random.next();
      const Vec3 local = squareToCosineHemisphere(u, v);
      return Vec3(local.x(), local.y(), std::max(local.z(), 0.05F)).normalized();
    };
    const Vec3 a = direction();
    const Vec3 b = direction();
    const Lanes<4> forward = bsdf().evaluate(a, b).value / b.z();
    const Lanes<4> backward = bsdf().evaluate(b, a).value / a.z();
    for (int k = 0; k < 4; ++k) {
      EXPECT_NEAR(forward[k], backward[k], 2e-4F * std::max(1.0F, forward[k])) << GetParam();
    }
  }
  for (const float cosine : {0.15F, 0.5F, 0.95F}) {
    const Vec3 out(std::sqrt(1.0F - cosine * cosine), 0.0F, cosine);
    Eigen::Array4d sum = Eigen::Array4d::Zero();
    constexpr int kDraws = 40000;
    for (int i = 0; i < kDraws; ++i) {
      const float u = random.next();
      const float v = random.next();
      const auto sample = bsdf().sample(out, u, v, [&] { return random.next(); });
      // Radiance changes with the square of the index across a surface; power does not.
      Lanes<4> weight = sample.weight;
      if (sample.direction.z() < 0.0F && weight[0] > 0.0F) {
        for (int k = 0; k < 4; ++k) {
          const float n = static_cast<float>(
              scene.materials[0].index.perNm[static_cast<std::size_t>(wavelengths.cell[static_cast<std::size_t>(k)])]);
          weight[k] *= n * n;
        }
      }
      sum += weight.cast<double>() / kDraws;
    }
    // Four standard errors of weights that spread by about their mean.
    EXPECT_LT(sum.maxCoeff(), 1.0 + 4.0 / std::sqrt(kDraws)) << GetParam() << " at " << cosine;
    std::printf("%s, cosine %.2f: gives back %.4f of the light\n", GetParam(), static_cast<double>(cosine), sum[0]);
  }
}

INSTANTIATE_TEST_SUITE_P(Materials, BsdfTest,
                         testing::Values("diffuse: 0.9", "conductor: {reflectance: 0.9, roughness: 0.5}",
                                         "conductor: {eta: 0.2, k: 3.5, roughness: 0.2}",
                                         "dielectric: {index: 1.5, roughness: 0.4}",
                                         "dielectric: {index: {cauchy: [1.5, 0.02]}, roughness: 0.3}"));

TEST(LightDensityTest, DirectionsFollowTheDensityOfTheirHits) {
  // All area lights and an environment at once, seen from one point.
  const Scene scene = sceneOf(
      "metamer_scene: 1\n"
      "shapes:\n"
      "  - rectangle: {center: [0, 3, 0], half_u: [1, 0, 0], half_v: [0, 0, 1.5]}\n    emission: 2\n"
      "  - sphere: {center: [3, 0.5, 1], radius: 1}\n    emission: 1\n"
      "lights: [{environment: {emission: 0.3}}]\n");
  const EmbreeScene shapes(scene);
  const LightTable lights(scene, shapes);
  const Vec3 from(0.2F, -0.5F, 0.1F);
  Random random;
  constexpr int kDraws = 300000;
  std::vector<double> counts(kDirectionCells);
  for (int i = 0; i < kDraws; ++i) {
    const std::uint32_t bits = random.bits();
    const float u = random.next();
    const float v = random.next();
    const LightSample sample = lights.sample(lights.choose(bits, u, v), from);
    ASSERT_GT(sample.pdf, 0.0F);
    counts[cellOf(sample.direction)] += 1;
  }
  const auto expected = expectedIn(
      [&](const Vec3& direction) {
        // The environment lies behind everything; the shapes do not hide each other here.
        double density = static_cast<double>(lights.environmentPdf(direction));
        Hit hit;
        const Ray ray{from, direction};
        if (shapes.intersect(ray, hit) && hit.emitter != kNone) {
          density += static_cast<double>(lights.pdf(hit, from, direction));
        }
        return density;
      },
      kDraws);
  EXPECT_GT(chiSquareProbability(counts, expected), kSignificance);
}

}  // namespace
}  // namespace metamer::spectral_ref
