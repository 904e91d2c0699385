// SPDX-License-Identifier: Apache-2.0
// Direct light against integrals worked out here: over the lamp by a fine grid, over wavelength by the 1 nm sum.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "metamer/spectral/colorimetry.h"
#include "spectral_ref/scene_fixture.h"

namespace metamer::spectral_ref {
namespace {

/// Integral of cos cos / r^2 from a point with a normal over a one-sided rectangle, by the midpoint rule.
double formIntegral(const Vector3& point, const Vector3& normal, const Rectangle& lamp, int steps) {
  const Vector3 lampNormal = lamp.halfU.cross(lamp.halfV).normalized();
  const double cell = 4.0 * lamp.halfU.cross(lamp.halfV).norm() / (steps * steps);
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      const Vector3 q =
          lamp.center + lamp.halfU * ((2.0 * i + 1.0) / steps - 1.0) + lamp.halfV * ((2.0 * j + 1.0) / steps - 1.0);
      const Vector3 d = q - point;
      const double r2 = d.squaredNorm();
      sum += std::max(0.0, d.dot(normal)) * std::max(0.0, -d.dot(lampNormal)) / (r2 * r2) * cell;
    }
  }
  return sum;
}

struct PatchPixels {
  int x, y, width, height;
};

/// The pixels well inside patch i of chartScene().
PatchPixels pixelsOf(const Scene& scene, int patch) {
  const Rectangle& rectangle = scene.rectangles[static_cast<std::size_t>(patch)];
  const double halfWidth = std::tan(0.5 * scene.camera.fovXDegrees * M_PI / 180.0);
  const double scale = 0.5 * scene.film.width / (halfWidth * scene.camera.origin.z());
  const auto toX = [&](double x) { return 0.5 * scene.film.width + x * scale; };
  const auto toY = [&](double y) { return 0.5 * scene.film.height - y * scale; };
  const int x0 = static_cast<int>(std::ceil(toX(rectangle.center.x() - 0.8 * rectangle.halfU.x())));
  const int x1 = static_cast<int>(std::floor(toX(rectangle.center.x() + 0.8 * rectangle.halfU.x())));
  const int y0 = static_cast<int>(std::ceil(toY(rectangle.center.y() + 0.8 * rectangle.halfV.y())));
  const int y1 = static_cast<int>(std::floor(toY(rectangle.center.y() - 0.8 * rectangle.halfV.y())));
  return {x0, y0, x1 - x0, y1 - y0};
}

/// Mean of the form integral over the scene points that a block of pixels sees.
double meanForm(const Scene& scene, const PatchPixels& pixels) {
  const double halfWidth = std::tan(0.5 * scene.camera.fovXDegrees * M_PI / 180.0);
  const double scale = 0.5 * scene.film.width / (halfWidth * scene.camera.origin.z());
  constexpr int kSteps = 12;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double x = (pixels.x + pixels.width * (i + 0.5) / kSteps - 0.5 * scene.film.width) / scale;
      const double y = (0.5 * scene.film.height - pixels.y - pixels.height * (j + 0.5) / kSteps) / scale;
      sum += formIntegral({x, y, 0}, Vector3::UnitZ(), scene.rectangles.back(), 24);
    }
  }
  return sum / (kSteps * kSteps);
}

struct ChartCase {
  int wavelengths;
  const char* lamp;
  std::uint64_t samples;
  double deltaE;  ///< noise included: spiky light needs more samples than a test has time for, or guiding
};

class ChartTest : public testing::TestWithParam<ChartCase> {};

TEST_P(ChartTest, EveryPatchIsWithinItsInterval) {
  const auto [wavelengths, lampName, samples, deltaE] = GetParam();
  const Scene scene = sceneOf(chartScene(wavelengths, lampName));
  const Film film = rendered(scene, samples);
  const spectral::DomainSamples lamp = scene.spectra[scene.rectangles.back().surface.emission->spectrum];
  const auto curves = scene.film.observer.onDomain();
  // White: what a perfect reflector in the middle would show.
  const Eigen::Vector3d white = curves.transpose() * lamp / curves.col(1).sum() *
                                formIntegral(Vector3::Zero(), Vector3::UnitZ(), scene.rectangles.back(), 48) / M_PI;
  double largest = 0;
  double squares = 0;
  for (int patch = 0; patch < 24; ++patch) {
    const Material& material = scene.materials[scene.rectangles[static_cast<std::size_t>(patch)].surface.material];
    const spectral::DomainSamples power = scene.spectra[material.colour].cwiseProduct(lamp);
    const PatchPixels pixels = pixelsOf(scene, patch);
    ASSERT_GE(pixels.width, 4);
    ASSERT_GE(pixels.height, 4);
    const Eigen::Vector3d expected = curves.transpose() * power / curves.col(1).sum() * meanForm(scene, pixels) / M_PI;
    const AreaMean mean = luminanceOver(film, pixels.x, pixels.y, pixels.width, pixels.height);
    Eigen::Vector3d actual = Eigen::Vector3d::Zero();
    for (int y = pixels.y; y < pixels.y + pixels.height; ++y) {
      const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(film.format().width);
      for (int x = pixels.x; x < pixels.x + pixels.width; ++x) {
        actual += film.colour(row + static_cast<std::size_t>(x));
      }
    }
    actual /= static_cast<double>(pixels.width) * pixels.height;
    const double z = (mean.mean - expected.y()) / mean.error;
    squares += z * z;
    // 24 patches in each of five cases: 3.9 is the two-sided quantile that all of them keep with 99 %.
    EXPECT_LT(std::abs(z), 3.9) << "patch " << patch << ": " << mean.mean << " against " << expected.y();
    largest = std::max(largest, spectral::deltaE2000(spectral::lab(actual, white), spectral::lab(expected, white)));
  }
  EXPECT_LT(largest, deltaE);
  // And the intervals are no wider than they need be: 24 squares of standard normal numbers lie between 7.0 and 52 with
  // 99.9 %.
  EXPECT_GT(squares, 7.0);
  EXPECT_LT(squares, 52.0);
  std::printf("wavelengths %d, %s: largest deltaE2000 %.4f, sum of z^2 over 24 patches %.1f\n", wavelengths, lampName,
              largest, squares);
}

INSTANTIATE_TEST_SUITE_P(Lamps, ChartTest,
                         testing::Values(ChartCase{4, "A", 512, 0.1}, ChartCase{1, "D65", 256, 0.5},
                                         ChartCase{8, "FL11", 256, 0.5}, ChartCase{16, "HP1", 256, 0.1}));

TEST(DirectLightTest, PointAndSpotFollowTheInverseSquare) {
  const std::string start =
      "metamer_scene: 1\n"
      "film: {width: 3, height: 3}\n"
      "camera: {origin: [0, 0, 10], target: [0, 0, 0], up: [0, 1, 0], fov_x: 0.01}\n"
      "integrator: {max_depth: 2}\n"
      "shapes: [{rectangle: {center: [0, 0, 0], half_u: [1, 0, 0], half_v: [0, 1, 0]}, diffuse: 0.5}]\n";
  // rho / pi * I cos / r^2, with the light at (3, 0, 4): r = 5, cos = 0.8.
  const double expected = 0.5 / M_PI * 7.0 * 0.8 / 25.0;
  const Film point = rendered(sceneOf(start + "lights: [{point: {position: [3, 0, 4], intensity: 7}}]\n"), 64);
  EXPECT_NEAR(luminanceOver(point, 0, 0, 3, 3).mean, expected, 1e-2 * expected);  // noise of the wavelengths
  const Film spot = rendered(
      sceneOf(start + "lights: [{spot: {position: [3, 0, 4], target: [0, 0, 0], intensity: 7, cone: 10, beam: 5}}]\n"),
      64);
  EXPECT_NEAR(luminanceOver(spot, 0, 0, 3, 3).mean, expected, 1e-2 * expected);
  const Film aside = rendered(
      sceneOf(start + "lights: [{spot: {position: [3, 0, 4], target: [3, 0, 0], intensity: 7, cone: 10, beam: 5}}]\n"),
      4);
  EXPECT_EQ(luminanceOver(aside, 0, 0, 3, 3).mean, 0.0);
}

TEST(DirectLightTest, LampsAndPaintHaveOneSide) {
  const std::string start =
      "metamer_scene: 1\n"
      "film: {width: 3, height: 3}\n"
      "camera: {origin: [0, 0, 10], target: [0, 0, 0], up: [0, 1, 0], fov_x: 1}\n";
  // The camera sees the back of the first rectangle, then of a lamp.
  const Film paint =
      rendered(sceneOf(start + "shapes: [{rectangle: {center: [0, 0, 0], half_u: [0, 1, 0], half_v: [1, 0, 0]}, "
                               "diffuse: 0.5}]\nlights: [{environment: {emission: 1}}]\n"),
               4);
  EXPECT_EQ(luminanceOver(paint, 0, 0, 3, 3).mean, 0.0);
  const Film lamp = rendered(
      sceneOf(start +
              "shapes: [{rectangle: {center: [0, 0, 0], half_u: [0, 1, 0], half_v: [1, 0, 0]}, emission: 1}]\n"),
      4);
  EXPECT_EQ(luminanceOver(lamp, 0, 0, 3, 3).mean, 0.0);
}

TEST(DirectLightTest, AGelBeforeALampColoursBothItsLookAndItsLight) {
  const auto scene = [](const std::string& gel, const std::string& target) {
    return sceneOf(
        "metamer_scene: 1\n"
        "film: {width: 8, height: 8}\n"
        "camera: {origin: [0, 0, 10], target: " +
        target +
        ", up: [0, 1, 0], fov_x: 2}\n"
        "integrator: {max_depth: 2, wavelengths: 8}\n"
        "shapes:\n"
        "  - rectangle: {center: [0, 0, 0], half_u: [1, 0, 0], half_v: [0, 1, 0]}\n"
        "    diffuse: 0.5\n"
        "  - sphere: {center: [5, 0, 3], radius: 0.6}\n"
        "    emission: 3\n" +
        gel);
  };
  const std::string gel = "  - sphere: {center: [5, 0, 3], radius: 0.8}\n    gel: 0.25\n";
  for (const std::string target : {"[0, 0, 0]", "[5, 0, 3]"}) {
    const AreaMean with = luminanceOver(rendered(scene(gel, target), 256), 0, 0, 8, 8);
    const AreaMean without = luminanceOver(rendered(scene("", target), 256), 0, 0, 8, 8);
    ASSERT_GT(without.mean, 0.0) << target;
    EXPECT_NEAR(with.mean, 0.25 * without.mean, 4.0 * std::hypot(with.error, 0.25 * without.error) + 1e-6) << target;
  }
}

TEST(DirectLightTest, ALampCloseByDoesNotHideItself) {
  for (const double distance : {0.5, 0.05, 0.005}) {
    for (const Restir restir : {Restir::Off, Restir::Lanes}) {
      const double half = 0.02 * distance;
      const Scene scene = sceneOf(
          "metamer_scene: 1\n"
          "film: {width: 1, height: 1}\n"
          "camera: {origin: [0, 0, 10], target: [0, 0, 0], up: [0, 1, 0], fov_x: 0.001}\n"
          "integrator: {max_depth: 2}\n"
          "shapes:\n"
          "  - rectangle: {center: [0, 0, 0], half_u: [1, 0, 0], half_v: [0, 1, 0]}\n    diffuse: 0.5\n"
          "  - rectangle: {center: [" +
          std::to_string(distance) + ", 0, " + std::to_string(distance) + "], half_u: [0, " + std::to_string(half) +
          ", 0], half_v: [" + std::to_string(half) + ", 0, 0]}\n    emission: 1\n");
      const double expected = 0.5 / M_PI * formIntegral(Vector3::Zero(), Vector3::UnitZ(), scene.rectangles[1], 64);
      // Near the whole lamp the integrand is almost constant: 256 samples leave far less than this.
      EXPECT_NEAR(rendered(scene, 256, {0, false, restir}).luminance(0).mean / expected, 1.0, 0.01) << distance;
    }
  }
}

}  // namespace
}  // namespace metamer::spectral_ref
