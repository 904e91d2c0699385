// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <bit>
#include <cstdio>
#include <limits>

#include "sip/transform/transform_fixture.h"

namespace metamer::sip {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(SpectralTransformTest, ALaserIsFinite) {
  TransformSpec spec = naturalSpecOf("D65", "D65");
  spec.input.illuminant = laser(532.0);
  const SpectralTransform transform(spec, 81);
  EXPECT_GT(transform.diagnostics().relaxation, 0.0);
  for (const Vector3d& colour : colours(200)) {
    ASSERT_TRUE(transform.apply(colour).allFinite()) << colour.transpose();
  }
  // To a laser every colour has the laser's hue, where nothing is limited: but for the nanometre that its line is wide.
  std::swap(spec.input, spec.output);
  const SpectralTransform toLaser(spec, 81);
  const Vector3d white = toLaser.apply(Vector3d::Ones());
  int whole = 0;
  for (const Vector3d& colour : colours(200)) {
    const Vector3d result = toLaser.apply(colour);
    ASSERT_TRUE(result.allFinite()) << colour.transpose();
    if (!toLaser.linearise(colour).isLimited) {
      ++whole;
      EXPECT_LE(result.cross(white).norm(), 1e-3 * result.norm() * white.norm()) << colour.transpose();
    }
  }
  EXPECT_GT(whole, 20);
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

/// A path of chromaticities in equal steps, through its corners.
struct Path {
  std::string name;
  std::vector<Eigen::Vector2d> corners;

  /// x, y and 1 - x - y as the tristimulus: no pole where y is 0.
  std::vector<Vector3d> colours(int steps) const {
    double length = 0.0;
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
      length += (corners[i + 1] - corners[i]).norm();
    }
    std::vector<Vector3d> places;
    for (int step = 0; step <= steps; ++step) {
      double left = step * length / steps;
      std::size_t i = 0;
      while (i + 2 < corners.size() && left > (corners[i + 1] - corners[i]).norm()) {
        left -= (corners[i + 1] - corners[i]).norm();
        ++i;
      }
      const Eigen::Vector2d xy = corners[i] + left * (corners[i + 1] - corners[i]).normalized();
      places.emplace_back(xy.x(), xy.y(), 1.0 - xy.x() - xy.y());
    }
    return places;
  }
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
  for (const auto& pair : std::vector<std::pair<std::string, std::string>>{
           {"D65", "A"}, {"D65", "HP1"}, {"D65", "LED-RGB1"}, {"HP1", "D65"}, {"LPS", "D65"}}) {
    TransformSpec spec = naturalSpecOf(pair.first, pair.second);
    spec.adaptation = 1.0;
    const SpectralTransform transform(spec, 41);
    const RelativeColours relative(transform);
    for (const Path& path : paths) {
      constexpr int kSteps = 600;
      double largestStep = 0.0;
      double largestSlope = 0.0;
      Vector3d colour = Vector3d::Zero();
      Vector3d result = Vector3d::Zero();
      for (const Vector3d& xyz : path.colours(kSteps)) {
        const Vector3d next = relative.fromXyz(xyz);
        const Vector3d nextResult = relative.apply(next);
        ASSERT_TRUE(nextResult.allFinite());
        if (!colour.isZero(0.0)) {
          largestStep = std::max(largestStep, (nextResult - result).norm() / (next - colour).norm());
        }
        largestSlope = std::max(largestSlope, relative.steepness(next));
        colour = next;
        result = nextResult;
      }
      std::printf("[ path ] %s, %s: largest step %.3g, derivative %.3g\n", pairName(pair).c_str(), path.name.c_str(),
                  largestStep, largestSlope);
      // A jump of a hundredth of the colour would be a step of 20 or more, and no derivative would tell of it. Sodium
      // alone, by which colours hardly differ but in brightness, stretches what little they do.
      if (pair.first != "LPS") {
        EXPECT_LE(largestStep, 6.0) << pairName(pair) << ", " << path.name;
      }
      EXPECT_LE(largestStep, 1.05 * largestSlope) << pairName(pair) << ", " << path.name;
    }
  }
}

}  // namespace
}  // namespace metamer::sip
