// SPDX-License-Identifier: Apache-2.0
// Light from all around on a diffuse plate, against closed forms.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "spectral_ref/picture_fixture.h"
#include "spectral_ref/scene_fixture.h"

namespace metamer::spectral_ref {
namespace {

/// A plate whose normal is `normal`, seen from along it.
std::string plate(const Vector3& normal, const std::string& environment) {
  const auto list = [](const Vector3& v) {
    return "[" + std::to_string(v.x()) + ", " + std::to_string(v.y()) + ", " + std::to_string(v.z()) + "]";
  };
  const Vector3 u = Vector3(0.3, 0.9, 0.1).cross(normal).normalized();
  const Vector3 v = normal.cross(u);
  return "metamer_scene: 1\n"
         "film: {width: 16, height: 16}\n"
         "camera: {origin: " +
         list(9.0 * normal) + ", target: [0, 0, 0], up: " + list(v) +
         ", fov_x: 4}\n"
         "integrator: {max_depth: 2, wavelengths: 4}\n"
         "lights: [{environment: {" +
         environment +
         "}}]\n"
         "shapes:\n"
         "  - rectangle: {center: [0, 0, 0], half_u: " +
         list(u) + ", half_v: " + list(v) + "}\n    diffuse: 0.4\n";
}

class EnvironmentTest : public testing::TestWithParam<RenderOptions> {};

TEST_P(EnvironmentTest, EvenLightTimesAlbedo) {
  const Scene scene = sceneOf(plate(Vector3(0.2, 0.5, 0.8).normalized(), "emission: D65"));
  const Film film = rendered(scene, 1024, GetParam());
  const auto curves = scene.film.observer.onDomain();
  const spectral::DomainSamples& lamp = scene.spectra[scene.pictures[0].emitters[0]];
  const Eigen::Vector3d expected = 0.4 * curves.transpose() * lamp / curves.col(1).sum();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t pixel = 0; pixel < film.format().pixels(); ++pixel) {
    mean += film.colour(pixel) / static_cast<double>(film.format().pixels());
  }
  // Five times what these means spread by over seeds. Resampled candidates know nothing of the cosine, and pixels share
  // them.
  const double bound = GetParam().restir == Restir::Off ? 5e-4 : 2.5e-3;
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(mean[c] / expected[c], 1.0, bound) << c;
    std::printf("even light, channel %d: %.6f of albedo times light\n", c, mean[c] / expected[c]);
  }
}

/// Integral of the cosine over a texel that lies wholly before the plate, top left corner at (column, row).
double cosineIntegral(const Vector3& normal, int column, int row, int width, int height) {
  // The middle looks along +z, +y is up, and from inside +x lies to the left of the middle.
  const double a = 2.0 * M_PI * (static_cast<double>(column) / width - 0.5);
  const double b = 2.0 * M_PI * (static_cast<double>(column + 1) / width - 0.5);
  const double top = M_PI * row / height;
  const double bottom = M_PI * (row + 1) / height;
  const double squares = 0.5 * (bottom - top) - 0.25 * (std::sin(2.0 * bottom) - std::sin(2.0 * top));  // of the sine
  const double mixed = 0.5 * (std::pow(std::sin(bottom), 2.0) - std::pow(std::sin(top), 2.0));  // sine times cosine
  return normal.dot(
      Vector3(-squares * (std::cos(a) - std::cos(b)), mixed * (b - a), squares * (std::sin(b) - std::sin(a))));
}

TEST_P(EnvironmentTest, OneBrightTexel) {
  constexpr int kWidth = 32;
  constexpr int kHeight = 16;
  struct Case {
    Vector3 normal;
    int column, row;
  };
  // Each quarter of the sphere, near a pole and at the equator, all before their plates.
  for (const auto& [normal, column, row] :
       {Case{{0, 0, -1}, 3, 5}, Case{{0, 0, 1}, 14, 8}, Case{{-0.6, 0, 0.8}, 21, 10}, Case{{0, 0.8, -0.6}, 29, 1},
        Case{{1, 0, 0}, 8, 7}, Case{{0, -1, 0}, 17, 14}}) {
    std::vector<float> values(std::size_t{kWidth} * kHeight);
    values[static_cast<std::size_t>(row) * kWidth + static_cast<std::size_t>(column)] = 50.0F;
    const auto file = exrFile("environment_test", kWidth, kHeight, 1, values);
    const Film film =
        rendered(sceneOf(plate(normal, "picture: " + file.string() + ", emitters: [1], scale: 2")), 256, GetParam());
    const double expected = 0.4 / M_PI * 100.0 * cosineIntegral(normal, column, row, kWidth, kHeight);
    const double mean = luminanceOver(film, 0, 0, 16, 16).mean;
    // Over seeds these means spread by 3e-4 at most.
    EXPECT_NEAR(mean / expected, 1.0, 1.5e-3) << column << ", " << row;
    std::printf("texel %d, %d: %.5f of the cosine's integral\n", column, row, mean / expected);
  }
}

TEST_P(EnvironmentTest, ATexelBehindThePlateIsNotSeen) {
  std::vector<float> values(32);
  values[8 + 4] = 50.0F;  // the middle, along +z
  const auto file = exrFile("environment_test_behind", 8, 4, 1, values);
  const Film film =
      rendered(sceneOf(plate(-Vector3::UnitZ(), "picture: " + file.string() + ", emitters: [1]")), 4, GetParam());
  EXPECT_EQ(luminanceOver(film, 0, 0, 16, 16).mean, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Integrators, EnvironmentTest,
                         testing::Values(RenderOptions{}, RenderOptions{0, true, Restir::Off},
                                         RenderOptions{0, false, Restir::Hero}, RenderOptions{0, true, Restir::Lanes}));

}  // namespace
}  // namespace metamer::spectral_ref
