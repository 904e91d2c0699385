// SPDX-License-Identifier: Apache-2.0
// Uniform, guided and resampled renders have the same expectation, and the variance that they state is the one they
// have: Z-tests over many seeds, Sidak-corrected.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "spectral_ref/scene_fixture.h"
#include "statistical/chi_square.h"

namespace metamer::spectral_ref {
namespace {

constexpr double kSignificance = 0.001;

int seeds() {
  const char* isLong = std::getenv("METAMER_LONG");  // NOLINT(concurrency-mt-unsafe)
  return isLong != nullptr && std::string(isLong) == "1" ? 400 : 8;
}

/// Mean over seeds, its standard error, and the mean of the stated variance.
struct Spread {
  double mean = 0;
  double variance = 0;  ///< of one seed's value, from the spread between seeds
  double stated = 0;    ///< from the pixels' variances
  int count = 0;
  double error() const { return std::sqrt(variance / count); }
};

struct Area {
  int x, y, width, height;
};

std::vector<Spread> spreadOver(const Scene& scene, const RenderOptions& options, std::uint64_t samples,
                               const std::vector<Area>& areas) {
  std::vector<std::vector<double>> values(areas.size());
  std::vector<Spread> result(areas.size());
  for (int seed = 0; seed < seeds(); ++seed) {
    RenderOptions one = options;
    one.seed = static_cast<std::uint32_t>(seed + 1000);
    const Film film = rendered(scene, samples, one);
    for (std::size_t a = 0; a < areas.size(); ++a) {
      const AreaMean mean = luminanceOver(film, areas[a].x, areas[a].y, areas[a].width, areas[a].height);
      values[a].push_back(mean.mean);
      result[a].stated += mean.error * mean.error / seeds();
    }
  }
  for (std::size_t a = 0; a < areas.size(); ++a) {
    Spread& spread = result[a];
    spread.count = seeds();
    for (const double value : values[a]) {
      spread.mean += value / spread.count;
    }
    for (const double value : values[a]) {
      spread.variance += (value - spread.mean) * (value - spread.mean) / (spread.count - 1);
    }
  }
  return result;
}

struct AgreementCase {
  const char* name;
  std::string scene;
  std::vector<Area> areas;
};

/// Coloured lamps of several kinds, some hidden by a ball, over a chart: light by every technique.
std::string manyLamps(const char* material) {
  std::string text =
      "metamer_scene: 1\n"
      "film: {width: 24, height: 16}\n"
      "camera: {origin: [0, 0, 10], target: [0, 0, 0], up: [0, 1, 0], fov_x: 34}\n"
      "integrator: {max_depth: 4, wavelengths: 4}\n"
      "spectra: {line: {wavelengths: [586, 589, 592], values: [0, 60, 0]}}\n"
      "shapes:\n"
      "  - chart: {center: [0, 0, 0], half_u: [3, 0, 0], half_v: [0, 2, 0], gap: 0}\n"
      "  - sphere: {center: [1, 0.5, 0.8], radius: 0.5}\n    ";
  text += material;
  text += "\n";
  for (int i = 0; i < 12; ++i) {
    const double x = -2.75 + 0.5 * i;
    text += "  - rectangle: {center: [" + std::to_string(x) + ", 2.4, " + std::to_string(0.4 + 0.2 * (i % 4)) +
            "], half_u: [0.1, 0, 0], half_v: [0, 0, 0.1]}\n    emission: " +
            (i % 3 == 0   ? "line"
             : i % 3 == 1 ? "5"
                          : "0.5") +
            "\n";
  }
  return text + "lights: [{environment: {emission: 0.02}}]\n";
}

/// Lamps that touch the chart and many small ones close to it: light cuts that look different from pixel to pixel, and
/// panels so near that BSDF sampling has its share.
std::string nearLamps() {
  std::string text =
      "metamer_scene: 1\n"
      "film: {width: 24, height: 16}\n"
      "camera: {origin: [0, 0, 10], target: [0, 0, 0], up: [0, 1, 0], fov_x: 34}\n"
      "integrator: {max_depth: 2, wavelengths: 4}\n"
      "spectra: {line: {wavelengths: [586, 589, 592], values: [0, 60, 0]}}\n"
      "shapes:\n"
      "  - chart: {center: [0, 0, 0], half_u: [3, 0, 0], half_v: [0, 2, 0], gap: 0}\n"
      "  - rectangle: {center: [-2.5, 0, 0.5], half_u: [0, 1, 0], half_v: [0, 0, 0.5]}\n    emission: 1\n"
      "  - rectangle: {center: [-2.5, 1.5, 0.5], half_u: [0, 0.5, 0], half_v: [0, 0, 0.5]}\n    emission: line\n";
  for (int i = 0; i < 120; ++i) {
    const int row = i / 12;
    const double x = -2.0 + 0.4 * (i % 12);
    const double y = -1.8 + 0.4 * row;
    text += "  - rectangle: {center: [" + std::to_string(x) + ", " + std::to_string(y) + ", " +
            std::to_string(0.05 + 0.1 * (i % 7)) + "], half_u: [0, 0.02, 0], half_v: [0.02, 0, 0]}\n    emission: " +
            (i % 5 == 0 ? "line" : std::to_string(1 + i % 3)) + "\n";
  }
  return text;
}

/// A large room under a fluorescent lamp, and a corner behind a partition under a red one: its pixels have wavelength
/// densities of their own.
std::string twoRooms() {
  return "metamer_scene: 1\n"
         "film: {width: 24, height: 16}\n"
         "camera: {origin: [0, 0, 10], target: [0, 0, 0], up: [0, 1, 0], fov_x: 34}\n"
         "integrator: {max_depth: 2, wavelengths: 4}\n"
         "spectra: {red: {wavelengths: [640, 700, 760], values: [0, 300, 0]}, white: {illuminant: FL11}}\n"
         "shapes:\n"
         "  - rectangle: {center: [0, 0, 0], half_u: [3, 0, 0], half_v: [0, 2, 0]}\n    diffuse: 0.5\n"
         "  - rectangle: {center: [1.3, 0, 1], half_u: [0, 3.5, 0], half_v: [0, 0, 1]}\n    diffuse: 0\n"
         "  - rectangle: {center: [1.2, 0, 1], half_u: [0, 0, 1], half_v: [0, 3.5, 0]}\n    diffuse: 0\n"
         "  - rectangle: {center: [-1, 3, 1.5], half_u: [0.3, 0, 0], half_v: [0, 0, 0.3]}\n    emission: white\n"
         "  - rectangle: {center: [2.2, 3, 1], half_u: [0.3, 0, 0], half_v: [0, 0, 0.3]}\n    emission: red\n";
}

class AgreementTest : public testing::TestWithParam<AgreementCase> {};

TEST_P(AgreementTest, MeansAndVariances) {
  const Scene scene = sceneOf(GetParam().scene);
  const std::vector<Area>& areas = GetParam().areas;
  constexpr std::uint64_t kSamples = 64;
  const std::vector<Spread> plain = spreadOver(scene, {}, kSamples, areas);
  const struct {
    const char* name;
    RenderOptions options;
  } others[] = {{"guided", {0, true, Restir::Off}},
                {"hero", {0, false, Restir::Hero}},
                {"lanes", {0, false, Restir::Lanes}},
                {"lights by power", {0, false, Restir::Off, LightRule::Power}},
                {"guided lanes", {0, true, Restir::Lanes}}};
  const int tests = static_cast<int>(std::size(others) * areas.size());
  for (const auto& other : others) {
    const std::vector<Spread> spread = spreadOver(scene, other.options, kSamples, areas);
    for (std::size_t a = 0; a < areas.size(); ++a) {
      const double z = (spread[a].mean - plain[a].mean) / std::hypot(spread[a].error(), plain[a].error());
      EXPECT_GT(sidakProbability(z, tests), kSignificance)
          << GetParam().name << ", " << other.name << ", area " << a << ": z " << z << ", " << spread[a].mean
          << " against " << plain[a].mean;
      std::printf("%s, %s, area %zu: z %+.2f, variance %.2g of plain, stated %.2f of true\n", GetParam().name,
                  other.name, a, z, spread[a].variance / plain[a].variance, spread[a].stated / spread[a].variance);
    }
  }
  for (std::size_t a = 0; a < areas.size(); ++a) {
    // The variance of a variance of n values is 2 / (n - 1) of its square; the stated one is far better known.
    const double z = (plain[a].variance / plain[a].stated - 1.0) / std::sqrt(2.0 / (plain[a].count - 1));
    EXPECT_LT(std::abs(z), 4.0) << GetParam().name << ", area " << a << ": stated variance " << plain[a].stated
                                << ", true " << plain[a].variance;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, AgreementTest,
    testing::Values(
        AgreementCase{
            "diffuse ball", manyLamps("diffuse: 0.8"), {{1, 1, 6, 4}, {9, 6, 6, 4}, {15, 4, 4, 4}, {0, 0, 24, 16}}},
        AgreementCase{"dispersive ball",
                      manyLamps("dielectric: {index: {cauchy: [1.5, 0.02]}}"),
                      {{1, 1, 6, 4}, {15, 4, 4, 4}, {0, 0, 24, 16}}},
        AgreementCase{
            "rough glass ball", manyLamps("dielectric: {index: 1.5, roughness: 0.3}"), {{15, 4, 4, 4}, {0, 0, 24, 16}}},
        AgreementCase{"lamps nearby", nearLamps(), {{2, 6, 2, 4}, {9, 6, 6, 4}, {20, 4, 4, 8}, {0, 0, 24, 16}}},
        AgreementCase{"two rooms", twoRooms(), {{2, 4, 8, 8}, {19, 4, 4, 8}, {0, 0, 24, 16}}}));

TEST(AgreementTest, TheRedRoomHasItsOwnWavelengths) {
  const Scene scene = sceneOf(twoRooms());
  Renderer renderer(scene, {0, true, Restir::Off});
  EXPECT_FALSE(renderer.wavelengthDensity(20, 8));
  renderer.render(1, 1e9);
  EXPECT_TRUE(renderer.wavelengthDensity(20, 8)->isOwn);
  EXPECT_FALSE(renderer.wavelengthDensity(5, 8)->isOwn);
}

/// Mean colour of a picture, over seeds.
struct ColourSpread {
  Eigen::Array3d mean = Eigen::Array3d::Zero();
  Eigen::Array3d error = Eigen::Array3d::Zero();
};

ColourSpread colourOverSeeds(const Scene& scene, std::uint64_t samples) {
  Eigen::Array3d squares = Eigen::Array3d::Zero();
  ColourSpread result;
  for (int seed = 0; seed < seeds(); ++seed) {
    const Film film = rendered(scene, samples, {static_cast<std::uint32_t>(seed + 1), false, Restir::Off});
    Eigen::Array3d colour = Eigen::Array3d::Zero();
    for (std::size_t pixel = 0; pixel < film.format().pixels(); ++pixel) {
      colour += film.colour(pixel).array() / static_cast<double>(film.format().pixels());
    }
    result.mean += colour / seeds();
    squares += colour.square() / seeds();
  }
  result.error = ((squares - result.mean.square()) / (seeds() - 1)).sqrt();
  return result;
}

TEST(LanesTest, APrismHasTheSameColourWithAnyNumberOfLanes) {
  // What 4.2.5 warns of: wrong weights between heroes show as a colour cast.
  std::vector<ColourSpread> colours;
  for (const int lanes : {1, 4, 8, 16}) {
    colours.push_back(
        colourOverSeeds(sceneOf("metamer_scene: 1\n"
                                "film: {width: 24, height: 16}\n"
                                "camera: {origin: [0, 0, 8], target: [0, 0, 0], up: [0, 1, 0], fov_x: 40}\n"
                                "integrator: {max_depth: 12, wavelengths: " +
                                std::to_string(lanes) +
                                "}\n"
                                "spectra: {lamp: {illuminant: D65, scale: 0.2}}\n"
                                "shapes:\n"
                                "  - sphere: {center: [0, 0, 0], radius: 1}\n"
                                "    dielectric: {index: {cauchy: [1.5, 0.03]}}\n"
                                "  - rectangle: {center: [0, 0, -2], half_u: [3, 0, 0], half_v: [0, 2, 0]}\n"
                                "    diffuse: 0.6\n"
                                "  - rectangle: {center: [-3, 2, 2], half_u: [0.5, 0.5, 0], half_v: [0, 0, 0.7]}\n"
                                "    emission: lamp\n"),
                        64));
  }
  for (std::size_t i = 1; i < colours.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double z = (colours[i].mean[c] - colours[0].mean[c]) / std::hypot(colours[i].error[c], colours[0].error[c]);
      EXPECT_GT(sidakProbability(z, 9), kSignificance) << "lanes case " << i << ", channel " << c << ": z " << z;
      std::printf("prism, lanes case %zu, channel %d: z %+.2f, error %.3g of one lane's\n", i, c, z,
                  colours[i].error[c] / colours[0].error[c]);
    }
  }
}

TEST(LanesTest, EveryNumberOfLanesHasTheSameExpectation) {
  const std::vector<Area> areas = {{15, 4, 4, 4}, {0, 0, 24, 16}};
  std::vector<std::vector<Spread>> spreads;
  for (const int lanes : {1, 4, 8, 16}) {
    std::string text = manyLamps("dielectric: {index: {cauchy: [1.5, 0.02]}, roughness: 0.2}");
    text.replace(text.find("wavelengths: 4"), 14, "wavelengths: " + std::to_string(lanes));
    spreads.push_back(spreadOver(sceneOf(text), {}, 64, areas));
  }
  for (std::size_t i = 1; i < spreads.size(); ++i) {
    for (std::size_t a = 0; a < areas.size(); ++a) {
      const double z =
          (spreads[i][a].mean - spreads[0][a].mean) / std::hypot(spreads[i][a].error(), spreads[0][a].error());
      EXPECT_GT(sidakProbability(z, 6), kSignificance) << i << ", area " << a << ": z " << z;
      std::printf("lanes case %zu, area %zu: z %+.2f\n", i, a, z);
    }
  }
}

}  // namespace
}  // namespace metamer::spectral_ref
