// SPDX-License-Identifier: Apache-2.0
// Fluorescent surfaces against linear algebra: in a closed room L = (I - P)^-1 E; a plate in a laser's light.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <functional>

#include "materials/fluorescence_table.h"
#include "spectral/fluorescence/made_matrix.h"
#include "spectral_ref/scene_fixture.h"

namespace metamer::spectral_ref {
namespace {

using spectral::ExcitationSamples;

constexpr int kSeeds = 20;
constexpr int kBinNm = 25;
constexpr const char* kBins = "{from: 392, to: 767, step: 25}";  // of whole cells: 380 ... 404 nm and so on

/// Green light for blue and ultraviolet, made. What it takes is not reflected.
constexpr const char* kSpectra =
    "spectra:\n"
    "  paint: {wavelengths: [440, 500, 700], values: [0.15, 0.5, 0.7]}\n"
    "  taken: {wavelengths: [300, 380, 450, 520], values: [0.3, 0.5, 0.75, 0]}\n"
    "  given: {wavelengths: [340, 360, 480, 530, 640], values: [0, 0.3, 0.1, 1, 0]}\n"
    "  lamp: {wavelengths: [300, 330, 400, 460, 620, 780], values: [0, 3, 0.5, 2, 1, 0.2]}\n";
constexpr const char* kDayGlo =
    "fluorescent: {reflectance: paint, excitation: taken, emission: given, quantum_yield: 0.9}";

std::string filmAnd(const std::string& rest, int wavelengths, int depth) {
  return "metamer_scene: 1\nfilm: {width: 4, height: 4, bins: " + std::string(kBins) +
         "}\nintegrator: {max_depth: " + std::to_string(depth) + ", wavelengths: " + std::to_string(wavelengths) +
         "}\n" + kSpectra + rest;
}

/// Six walls that face each other, all of one material and with one emission.
std::string room(int wavelengths, const std::string& inside) {
  std::string text = filmAnd(
      "camera: {origin: [0.1, 0.2, 0.95], target: [0, 0, -1], up: [0, 1, 0], fov_x: 70}\nshapes:\n", wavelengths, 64);
  constexpr const char* kWalls[] = {"center: [-1, 0, 0], half_u: [0, 1, 0], half_v: [0, 0, 1]",
                                    "center: [1, 0, 0], half_u: [0, 0, 1], half_v: [0, 1, 0]",
                                    "center: [0, -1, 0], half_u: [0, 0, 1], half_v: [1, 0, 0]",
                                    "center: [0, 1, 0], half_u: [1, 0, 0], half_v: [0, 0, 1]",
                                    "center: [0, 0, -1], half_u: [1, 0, 0], half_v: [0, 1, 0]",
                                    "center: [0, 0, 1], half_u: [0, 1, 0], half_v: [1, 0, 0]"};
  for (const char* wall : kWalls) {
    text += std::string("  - rectangle: {") + wall + "}\n    " + kDayGlo + "\n    emission: lamp\n";
  }
  return text + inside;
}

/// Spectrum of a scene's last rectangle, a lamp.
ExcitationSamples lampOf(const Scene& scene) {
  ExcitationSamples lamp = ExcitationSamples::Zero();
  const auto& emission = scene.rectangles.back().surface.emission;
  lamp << scene.ultraviolet[emission->spectrum], scene.spectra[emission->spectrum];
  return lamp;
}

double meanOver(const ExcitationSamples& samples, int bin) {
  return samples.segment<kBinNm>(spectral::kDomainInExcitation + kBinNm * bin).mean();
}

struct RoomCase {
  const char* name;
  int wavelengths;
  RenderOptions options;
  const char* inside;
};

std::ostream& operator<<(std::ostream& stream, const RoomCase& one) {
  return stream << one.name;
}

class FluorescentRoomTest : public testing::TestWithParam<RoomCase> {};

TEST_P(FluorescentRoomTest, IsTheSolutionOfItsEquation) {
  const Scene scene = sceneOf(room(GetParam().wavelengths, GetParam().inside));
  const spectral::FluorescentSamples& walls = scene.fluorescences.front();
  EXPECT_LE(walls.mostPhotons(), 1.0 + 1e-12);
  Eigen::MatrixXd kernel = walls.perNm;
  kernel.diagonal() += walls.reflectance;
  const Eigen::MatrixXd equation =
      Eigen::MatrixXd::Identity(spectral::kExcitationSize, spectral::kExcitationSize) - kernel;
  const ExcitationSamples expected = equation.partialPivLu().solve(lampOf(scene));

  const int bins = scene.film.bins.count;
  std::vector<std::vector<double>> means(static_cast<std::size_t>(bins));
  for (int seed = 0; seed < kSeeds; ++seed) {
    RenderOptions options = GetParam().options;
    options.seed = static_cast<std::uint32_t>(seed + 1);
    const Film film = rendered(scene, 128, options);
    for (int bin = 0; bin < bins; ++bin) {
      means[static_cast<std::size_t>(bin)].push_back(meanRadiance(film, bin));
    }
  }
  double largest = 0;
  for (int bin = 0; bin < bins; ++bin) {
    const Eigen::Map<const Eigen::ArrayXd> values(means[static_cast<std::size_t>(bin)].data(), kSeeds);
    const double mean = values.mean();
    const double error = std::sqrt((values - mean).square().sum() / (kSeeds - 1) / kSeeds);
    const double z = (mean - meanOver(expected, bin)) / error;
    EXPECT_LT(std::abs(z), 4.0) << "bin " << bin << ": " << mean << " +- " << error << ", expected "
                                << meanOver(expected, bin);
    EXPECT_LT(error, 0.1 * mean);
    largest = std::max(largest, std::abs(z));
  }
  std::printf("%s: largest |z| of %d bins %.2f\n", GetParam().name, bins, largest);
}

constexpr const char* kPrism =
    "  - sphere: {center: [0.2, 0, -0.2], radius: 0.5}\n    dielectric: {index: {cauchy: [1.5, 0.01]}}\n";

INSTANTIATE_TEST_SUITE_P(
    Rooms, FluorescentRoomTest,
    testing::Values(RoomCase{"one lane", 1, {}, ""}, RoomCase{"four lanes", 4, {}, ""},
                    RoomCase{"sixteen lanes", 16, {}, ""}, RoomCase{"guided", 4, {0, true, Restir::Off}, ""},
                    RoomCase{"restir lanes", 4, {0, false, Restir::Lanes}, ""},
                    RoomCase{"restir hero", 4, {0, false, Restir::Hero}, ""},
                    RoomCase{"guided restir lanes", 4, {0, true, Restir::Lanes}, ""},
                    RoomCase{"dispersive glass", 4, {}, kPrism},
                    RoomCase{"guided dispersive glass, restir lanes", 4, {0, true, Restir::Lanes}, kPrism}));

/// A plate under a small lamp.
std::string plate(const std::string& material, const std::string& lamp) {
  return filmAnd(
      "  laser: {wavelengths: [404.9, 405, 405.1], values: [0, 900, 0]}\n"
      "  black_light: {wavelengths: [364.95, 365, 365.05], values: [0, 2000, 0]}\n"
      "camera: {origin: [0, 0, 4], target: [0, 0, 0], up: [0, 1, 0], fov_x: 10}\nshapes:\n"
      "  - rectangle: {center: [0, 0, 0], half_u: [1, 0, 0], half_v: [0, 1, 0]}\n    " +
          material +
          "\n  - rectangle: {center: [-1.5, 1, 2], half_u: [0.2, 0, 0], half_v: [0, 0, 0.2]}\n    emission: " + lamp +
          "\n",
      4, 2);
}

double worstZ(const Film& film, const std::function<double(int)>& expected) {
  double largest = 0;
  for (int bin = 0; bin < film.format().bins.count; ++bin) {
    double squares = 0;
    const double mean = meanRadiance(film, bin);
    for (std::size_t i = 0; i < film.format().pixels(); ++i) {
      squares += std::pow(film.radiance(i, bin) - mean, 2.0);
    }
    const auto pixels = static_cast<double>(film.format().pixels());
    const double error = std::sqrt(squares / (pixels - 1) / pixels);
    largest = std::max(largest, std::abs(mean - expected(bin)) / std::max(error, 1e-9));
  }
  return largest;
}

TEST(FluorescentPlateTest, GivesItsPureEmissionInALaser) {
  // How much of even light a white plate gives back at each pixel; its mean over pixels serves both.
  const Film white = rendered(sceneOf(plate("diffuse: 1", "1")), 4096);
  double form = 0;
  for (int bin = 0; bin < white.format().bins.count; ++bin) {
    form += meanRadiance(white, bin) / white.format().bins.count;
  }
  for (const char* laser : {"laser", "black_light"}) {
    const Scene scene = sceneOf(plate(kDayGlo, laser));
    const ExcitationSamples given = scene.fluorescences.front().givenBack(lampOf(scene));
    const Film film = rendered(scene, 4096);
    EXPECT_LT(worstZ(film, [&](int bin) { return form * meanOver(given, bin); }), 4.0) << laser;
    // From 655 nm on the dye gives nothing, and nothing of the laser is there: not a trace.
    for (int bin = 11; bin < film.format().bins.count; ++bin) {
      EXPECT_EQ(meanRadiance(film, bin), 0.0) << laser << ", bin " << bin;
    }
    EXPECT_GT(meanRadiance(film, 5), 0.0);
  }
}

TEST(FluorescentPlateTest, WithoutEmissionItIsDiffuseToTheBit) {
  const Film diffuse = rendered(sceneOf(plate("diffuse: paint", "lamp")), 16);
  for (const char* given :
       {"fluorescent: {reflectance: paint, excitation: 0, emission: given, quantum_yield: 0.9}",
        "fluorescent: {reflectance: paint, excitation: taken, emission: given, quantum_yield: 0}"}) {
    const Film film = rendered(sceneOf(plate(given, "lamp")), 16);
    for (std::size_t i = 0; i < film.format().pixels(); ++i) {
      EXPECT_EQ(film.colour(i), diffuse.colour(i)) << given;
      for (int bin = 0; bin < film.format().bins.count; ++bin) {
        EXPECT_EQ(film.radiance(i, bin), diffuse.radiance(i, bin)) << given;
      }
    }
  }
}

TEST(FluorescentPlateTest, OthersKeepTheirRandomNumbers) {
  // A fluorescent surface that no path meets changes no bit of a picture.
  const std::string scene = plate("diffuse: paint", "1");
  const Film alone = rendered(sceneOf(scene), 16);
  const Film beside =
      rendered(sceneOf(scene + "  - rectangle: {center: [0, 0, 9], half_u: [1, 0, 0], half_v: [0, 1, 0]}\n    " +
                       kDayGlo + "\n"),
               16);
  for (std::size_t i = 0; i < alone.format().pixels(); ++i) {
    EXPECT_EQ(alone.colour(i), beside.colour(i));
  }
}

TEST(FluorescenceTableTest, DrawsInProportion) {
  const spectral::FluorescentSamples surface = spectral::samplesOf(spectral::madeMatrix());
  ExcitationSamples light = ExcitationSamples::Zero();
  light.segment<60>(40).setConstant(1.0);
  light[150] = 20.0;
  const FluorescenceTable table(surface, light);
  for (const int emission : {120, 140, 200, 260}) {  // 500 to 640 nm
    constexpr int kDraws = 1 << 18;
    ExcitationSamples found = ExcitationSamples::Zero();
    for (int k = 0; k < kDraws; ++k) {
      const auto drawn = table.sample(emission, (static_cast<float>(k) + 0.5F) / kDraws);
      ASSERT_LT(drawn.cell, emission);
      ASSERT_GE(drawn.cell, -kUltravioletCells);
      found[drawn.cell + kUltravioletCells] += static_cast<double>(drawn.weight) / kDraws;
    }
    const ExcitationSamples expected = surface.perNm.row(emission + kUltravioletCells).transpose();
    // Each excitation's share of even numbers is off by one of them at most.
    EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 3.0 / kDraws * expected.sum() * 5.0 + 1e-6) << emission;
    EXPECT_NEAR(found.sum() / expected.sum(), 1.0, 1e-3);
  }
  EXPECT_EQ(table.shifted(-kUltravioletCells), 0.0F);
}

}  // namespace
}  // namespace metamer::spectral_ref
