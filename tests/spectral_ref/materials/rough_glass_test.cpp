// SPDX-License-Identifier: Apache-2.0
// Rough glass in even light. Its model has one bounce among facets and no more, so a rough plate gives back less than
// it gets: how much less is worked out here from Walter et al. 2007, by a sum over facets in double precision, where
// the renderer draws directions.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "spectral_ref/scene_fixture.h"

namespace metamer::spectral_ref {
namespace {

constexpr double kIndex = 1.5;

/// Shares of the light from one direction.
struct Shares {
  double reflected = 0;
  double refracted = 0;
};

/// What a rough plate does with light from the direction (sine, 0, cosine) above it.
/// @param eta  index of the other side over that of this one
Shares sharesOf(double alpha, double cosine, double eta) {
  const double sine = std::sqrt(1.0 - cosine * cosine);
  const auto lambda = [alpha](double z) {
    return 0.5 * (std::sqrt(1.0 + alpha * alpha * (1.0 - z * z) / (z * z)) - 1.0);
  };
  Shares shares;
  constexpr int kSlopes = 800;
  constexpr int kTurns = 800;
  for (int i = 0; i < kSlopes; ++i) {
    // tan^2 = alpha^2 p / (1 - p), where p is the share of facets, by area seen from above, that are less steep. Steps
    // shrink towards the steepest.
    const double q = 1.0 - (i + 0.5) / kSlopes;
    const double share = 2.0 * q / kSlopes / kTurns;
    const double up = 1.0 / std::sqrt(1.0 + alpha * alpha * (1.0 - q * q) / (q * q));
    const double slant = std::sqrt(1.0 - up * up);
    for (int j = 0; j < kTurns; ++j) {
      const double facing = sine * slant * std::cos(2.0 * M_PI * (j + 0.5) / kTurns) + cosine * up;
      if (facing <= 0) {
        continue;
      }
      const double area = share * facing / (cosine * up);  // as `out` sees it, over the plate's
      const double inside2 = 1.0 - (1.0 - facing * facing) / (eta * eta);
      double fresnel = 1.0;
      if (inside2 > 0) {
        const double inside = std::sqrt(inside2);
        const double parallel = (eta * facing - inside) / (eta * facing + inside);
        const double across = (facing - eta * inside) / (facing + eta * inside);
        fresnel = 0.5 * (parallel * parallel + across * across);
        const double down = -cosine / eta + (facing / eta - inside) * up;
        if (down < 0) {
          shares.refracted += area * (1.0 - fresnel) / (1.0 + lambda(cosine) + lambda(-down));
        }
      }
      const double rising = 2.0 * facing * up - cosine;
      if (rising > 0) {
        shares.reflected += area * fresnel / (1.0 + lambda(cosine) + lambda(rising));
      }
    }
  }
  return shares;
}

std::string inEvenLight(const std::string& camera, int depth, const std::string& shape) {
  return "metamer_scene: 1\n"
         "film: {width: 16, height: 16}\n"
         "camera: " +
         camera + "\nintegrator: {max_depth: " + std::to_string(depth) +
         ", wavelengths: 4}\n"
         "lights: [{environment: {emission: 1}}]\n"
         "shapes:\n" +
         shape;
}

double luminanceOf(const std::string& scene, std::uint64_t samples) {
  return luminanceOver(rendered(sceneOf(scene), samples), 0, 0, 16, 16).mean;
}

class RoughGlassTest : public testing::TestWithParam<double> {};

TEST_P(RoughGlassTest, APlateGivesBackWhatItsFacetsDo) {
  const double alpha = GetParam();
  for (const double cosine : {0.95, 0.6, 0.3}) {
    for (const bool fromInside : {false, true}) {
      const double eta = fromInside ? 1.0 / kIndex : kIndex;
      const Shares shares = sharesOf(alpha, cosine, eta);
      EXPECT_LE(shares.reflected + shares.refracted, 1.0 + 1e-6);
      // Radiance changes by the square of the index, and even light on both sides is all there is to see.
      const double expected = shares.reflected + shares.refracted / (eta * eta);
      const std::string camera = "{origin: [" + std::to_string(9.0 * std::sqrt(1.0 - cosine * cosine)) + ", 0, " +
                                 std::to_string(fromInside ? -9.0 * cosine : 9.0 * cosine) +
                                 "], target: [0, 0, 0], fov_x: 0.01}";
      const double plate =
          luminanceOf(inEvenLight(camera, 2,
                                  "  - rectangle: {center: [0, 0, 0], half_u: [1, 0, 0], half_v: [0, 1, 0]}\n"
                                  "    dielectric: {index: 1.5, roughness: " +
                                      std::to_string(alpha) + "}\n"),
                      1024);
      const double nothing = luminanceOf(inEvenLight(camera, 2, "  []\n"), 1024);
      EXPECT_NEAR(plate / nothing, expected, 1e-3 * expected) << "cosine " << cosine << (fromInside ? ", inside" : "");
      std::printf("alpha %.3f, cosine %.2f, from %s: gives back %.4f; rendered over expected, less 1: %+.1e\n", alpha,
                  cosine, fromInside ? "inside " : "outside", shares.reflected + shares.refracted,
                  plate / nothing / expected - 1.0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Roughness, RoughGlassTest, testing::Values(0.1, 0.3, 0.6, 1.0));

/// What docs/spectral_ref.md says a ball of rough glass gives back of even light, by roughness and index.
TEST(RoughGlassTest, ABallLosesWhatTheManualSays) {
  const std::string camera = "{origin: [0, 0, 4], target: [0, 0, 0], fov_x: 40}";
  const auto ball = [&](const std::string& material) {
    return luminanceOf(inEvenLight(camera, 64, "  - sphere: {center: [0, 0, 0], radius: 1}\n    " + material + "\n"),
                       128);
  };
  const double nothing = luminanceOf(inEvenLight(camera, 64, "  []\n"), 128);
  const double black = ball("diffuse: 0");
  const struct {
    const char* roughness;
    std::array<double, 3> givenBack;  ///< by index 1.33, 1.5, 1.8
  } rows[] = {{"0.1", {0.946, 0.937, 0.920}},
              {"0.2", {0.857, 0.830, 0.789}},
              {"0.4", {0.690, 0.633, 0.558}},
              {"1", {0.415, 0.335, 0.250}}};
  constexpr std::array<const char*, 3> kIndices = {"1.33", "1.5", "1.8"};
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < kIndices.size(); ++i) {
      const double glass =
          ball(std::string("dielectric: {index: ") + kIndices[i] + ", roughness: " + row.roughness + "}");
      // Two digits are what the manual gives.
      EXPECT_NEAR(1.0 - (nothing - glass) / (nothing - black), row.givenBack[i], 5e-3)
          << "roughness " << row.roughness << ", index " << kIndices[i];
    }
  }
}

TEST(RoughGlassTest, ABallAddsNoLight) {
  const std::string camera = "{origin: [0, 0, 4], target: [0, 0, 0], fov_x: 40}";
  const double nothing = luminanceOf(inEvenLight(camera, 64, "  []\n"), 256);
  double last = 1.0 + 1e-3;
  for (const char* roughness : {"0.001", "0.2", "0.5", "1"}) {
    const double ball = luminanceOf(inEvenLight(camera, 64,
                                                "  - sphere: {center: [0, 0, 0], radius: 1}\n"
                                                "    dielectric: {index: 1.5, roughness: " +
                                                    std::string(roughness) + "}\n"),
                                    256) /
                        nothing;
    // The rougher, the more is lost between facets; the smoothest loses nothing.
    EXPECT_LT(ball, last) << roughness;
    last = ball;
    if (std::string(roughness) == "0.001") {
      EXPECT_NEAR(ball, 1.0, 1e-3);
    }
    std::printf("rough ball, alpha %s: picture %.4f of the light\n", roughness, ball);
  }
}

}  // namespace
}  // namespace metamer::spectral_ref
