// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <bit>
#include <cstdio>
#include <limits>

#include "metamer/sip/feasible_cone.h"
#include "sip/transform/transform_fixture.h"

namespace metamer::sip {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// The largest gain of a transform on whole colours, and of its derivative.
struct Gain {
  double whole = 0.0;
  double local = 0.0;
};

Gain largestGain(const SpectralTransform& transform) {
  Gain gain;
  for (const Vector3d& colour : colours(3000)) {
    const Vector3d result = transform.apply(colour);
    const auto piece = transform.linearise(colour);
    EXPECT_TRUE(result.allFinite() && piece.matrix.allFinite()) << colour.transpose();
    gain.whole = std::max(gain.whole, result.norm() / colour.norm());
    gain.local = std::max(gain.local, Eigen::JacobiSVD<Matrix3d>(piece.matrix).singularValues()[0]);
  }
  return gain;
}

TEST(SpectralTransformTest, GainIsBounded) {
  // Sodium, lines on a faint ground, narrow emitters with darkness between them, and everyday light.
  for (const char* const light : {"LPS", "HPS", "HP1", "Mercury", "FL11", "3-LED-1 (457/540/605)",
                                  "4-LED-1 (461/526/576/624)", "LED-RGB1", "LED-B2", "A"}) {
    for (const int bands : {16, 41, 81, kDefaultBandCount, kConvergedBandCount}) {
      const SpectralTransform transform(specOf(light, "D65"), bands);
      const auto diagnostics = transform.diagnostics();
      const Gain gain = largestGain(transform);
      std::printf("[ gain ] %s -> D65, %d bands: rank %d, condition %.3g, matrix %.3g, whole %.3g, local %.3g\n", light,
                  bands, diagnostics.rank, diagnostics.conditionNumber, diagnostics.matrixGain, gain.whole, gain.local);
      // The faintest band that the cone reaches into takes a reflectance this much brighter than white. Sixteen bands
      // are wider than an emitter: some of them are fainter themselves.
      if (bands > 16) {
        EXPECT_LT(gain.whole, diagnostics.matrixGain / kFaintGenerator) << light << " " << bands;
      }
      // The steepest place is the strip along the locus that the cone is drawn in by.
      EXPECT_LT(gain.local, gain.whole / FeasibleCone::kMargin) << light << " " << bands;
      EXPECT_EQ(diagnostics.rank < 3, std::string(light) == "LPS") << light << " " << bands;
    }
  }
  EXPECT_EQ(SpectralTransform(specOf("D65", "LPS")).diagnostics().rank, 3);
}

TEST(SpectralTransformTest, ALaserIsFinite) {
  TransformSpec spec = specOf("D65", "D65");
  spec.input.illuminant = spectral::Spectrum("laser", spectral::SpectralQuantity::SpectralPowerDistribution,
                                             {531.0, 532.0, 533.0}, {0.0, 1.0, 0.0});
  const SpectralTransform transform(spec);
  EXPECT_EQ(transform.diagnostics().rank, 1);
  for (const Vector3d& colour : colours(200)) {
    ASSERT_TRUE(transform.apply(colour).allFinite()) << colour.transpose();
  }
  // To a laser every colour has the laser's hue.
  std::swap(spec.input, spec.output);
  const SpectralTransform toLaser(spec);
  const Vector3d white = toLaser.apply(Vector3d::Ones());
  for (const Vector3d& colour : colours(200)) {
    if (toLaser.isFeasible(colour)) {
      const Vector3d result = toLaser.apply(colour);
      EXPECT_LE(result.cross(white).norm(), 1e-9 * result.norm() * white.norm()) << colour.transpose();
    }
  }
}

TEST(SpectralTransformTest, HardPixels) {
  for (const auto& pair : lightPairs()) {
    const SpectralTransform transform(specOf(pair.first, pair.second));
    EXPECT_TRUE(transform.apply(Vector3d::Zero()).isZero(0.0));
    constexpr double kDenormal = std::numeric_limits<double>::denorm_min();
    for (const double size : {1e30, 65504.0, 1e-30, 1e-300, static_cast<double>(1e-42F), kDenormal}) {
      for (const Vector3d& colour : colours(60)) {
        ASSERT_TRUE(transform.apply(size * colour).allFinite())
            << pairName(pair) << ": " << (size * colour).transpose();
      }
    }
    for (const double odd : {kNan, kInfinity, -kInfinity}) {
      for (int k = 0; k < 3; ++k) {
        Vector3d colour(0.1, 0.2, 0.3);
        colour[k] = odd;
        const Vector3d result = transform.apply(colour);
        for (int i = 0; i < 3; ++i) {
          EXPECT_EQ(std::bit_cast<std::uint64_t>(result[i]), std::bit_cast<std::uint64_t>(colour[i]));
        }
      }
    }
    // In float, beside ordinary pixels, alpha untouched whatever it is.
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    std::vector<float> pixels{0.1F,     0.2F, 0.3F,   nan,  nan,    0.2F, 0.3F,     0.5F,  0.1F, 0.2F,  0.3F,
                              infinity, 0.1F, 0.2F,   0.3F, 1e-42F, 0.1F, infinity, 0.3F,  1.0F, 1e30F, -1e30F,
                              1e30F,    1.0F, 1e-42F, 0.0F, 1e-42F, 1.0F, 0.0F,     -0.0F, 0.0F, 0.0F};
    const std::vector<float> before = pixels;
    transform.apply(pixels);
    const Vector3d expected = transform.apply(Eigen::Map<const Eigen::Vector3f>(before.data()).cast<double>());
    for (std::size_t i = 0; i < pixels.size(); i += 4) {
      EXPECT_EQ(std::bit_cast<std::uint32_t>(pixels[i + 3]), std::bit_cast<std::uint32_t>(before[i + 3]));
      const Eigen::Map<const Eigen::Vector3f> was(before.data() + i);
      const Eigen::Map<const Eigen::Vector3f> is(pixels.data() + i);
      if (!was.allFinite()) {
        for (int k = 0; k < 3; ++k) {
          EXPECT_EQ(std::bit_cast<std::uint32_t>(is[k]), std::bit_cast<std::uint32_t>(was[k]));
        }
      } else {
        EXPECT_TRUE(is.allFinite()) << was.transpose();
      }
      if (i == 0 || i == 8 || i == 12) {
        EXPECT_EQ(is, Eigen::Vector3f(expected.cast<float>()));
      }
    }
    transform.apply(std::span<float>());
  }
}

/// A path of chromaticities in equal steps, closed through its corners.
struct Path {
  std::string name;
  std::vector<Eigen::Vector2d> corners;
};

TEST(SpectralTransformTest, PathsAcrossTheLocusAndThePurpleLineDoNotJump) {
  const std::vector<Path> paths{
      {"green across the locus", {{0.3127, 0.329}, {0.1, 0.9}}},
      {"red across the locus", {{0.3127, 0.329}, {0.78, 0.28}}},
      {"cyan across the locus", {{0.3127, 0.329}, {0.0, 0.35}}},
      {"blue across the corner", {{0.3127, 0.329}, {0.16, -0.02}}},
      {"across the purple line", {{0.3127, 0.329}, {0.45, 0.02}}},
      {"along the purple line", {{0.16, 0.01}, {0.75, 0.27}}},
      {"round outside", {{0.05, 0.9}, {0.8, 0.3}, {0.15, 0.005}, {-0.05, 0.4}, {0.05, 0.9}}},
  };
  for (const auto& pair : std::vector<std::pair<std::string, std::string>>{{"D65", "A"},
                                                                           {"D65", "HP1"},
                                                                           {"D65", "FL11"},
                                                                           {"D65", "LED-RGB1"},
                                                                           {"A", "D65"},
                                                                           {"HP1", "D65"},
                                                                           {"LPS", "D65"}}) {
    const SpectralTransform transform(specOf(pair.first, pair.second), 81);
    const Matrix3d rgbFromXyz = transform.space().rgbFromXyz();
    for (const Path& path : paths) {
      double length = 0.0;
      for (std::size_t i = 0; i + 1 < path.corners.size(); ++i) {
        length += (path.corners[i + 1] - path.corners[i]).norm();
      }
      constexpr int kSteps = 100'000;
      // x, y and 1 - x - y as the tristimulus: no pole where y is 0.
      const auto colourAt = [&](double share) -> Vector3d {
        double left = share * length;
        std::size_t i = 0;
        while (i + 2 < path.corners.size() && left > (path.corners[i + 1] - path.corners[i]).norm()) {
          left -= (path.corners[i + 1] - path.corners[i]).norm();
          ++i;
        }
        const Eigen::Vector2d xy = path.corners[i] + left * (path.corners[i + 1] - path.corners[i]).normalized();
        return rgbFromXyz * Vector3d(xy.x(), xy.y(), 1.0 - xy.x() - xy.y());
      };
      double largestGain = 0.0;
      double largestStep = 0.0;
      double largestUnexplained = 0.0;
      Vector3d colour = colourAt(0.0);
      auto local = transform.linearise(colour);
      for (int i = 1; i <= kSteps; ++i) {
        const Vector3d next = colourAt(static_cast<double>(i) / kSteps);
        const auto nextLocal = transform.linearise(next, &local.active);
        ASSERT_TRUE(nextLocal.value.allFinite());
        const double step = (next - colour).norm();
        const double jump = (nextLocal.value - local.value).norm();
        // What the derivatives at both ends allow a continuous function on the way.
        const double slope = std::max(Eigen::JacobiSVD<Matrix3d>(local.matrix).singularValues()[0],
                                      Eigen::JacobiSVD<Matrix3d>(nextLocal.matrix).singularValues()[0]);
        largestGain = std::max(largestGain, slope);
        largestStep = std::max(largestStep, jump / step);
        // 1e-3 of the output per step of 1e-4, or what the slope explains.
        const double allowed =
            std::max(10.0 * step * std::max(nextLocal.value.norm(), local.value.norm()), 1.01 * slope * step);
        largestUnexplained = std::max(largestUnexplained, jump / allowed);
        colour = next;
        local = nextLocal;
      }
      const double gain = transform.diagnostics().matrixGain;
      std::printf(
          "[ path ] %s, %s: largest slope %.3g, derivative %.3g, of the matrix %.3g; step against allowed %.3g\n",
          pairName(pair).c_str(), path.name.c_str(), largestStep, largestGain, gain, largestUnexplained);
      EXPECT_LE(largestUnexplained, 1.0) << pairName(pair) << ", " << path.name;
      // The cone is drawn in by 1e-3 of the way to white: a step there spans up to a thousand times the reflectance
      // range that it spans at white, for either light.
      EXPECT_LE(largestGain, 1000.0 * gain) << pairName(pair) << ", " << path.name;
    }
  }
}

}  // namespace
}  // namespace metamer::sip
