// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/spectral_transform.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

#include "metamer/sip/error_protocol.h"
#include "metamer/sip/feasible_cone.h"
#include "metamer/spectral/colorimetry.h"
#include "sip_fixture.h"

namespace metamer::sip {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using spectral::chromaticity;
using spectral::xyzFromChromaticity;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Colours of everyday and worse: inside the gamut, on its border, far outside it.
std::vector<Vector3d> colours(int count, unsigned seed = 3) {
  std::mt19937 random(seed);
  const auto uniform = [&random] { return unitRandom(random); };
  std::vector<Vector3d> made;
  for (int i = 0; i < count; ++i) {
    Vector3d colour{uniform(), uniform(), uniform()};  // in braces: one after another
    if (i % 3 == 1) {
      colour[i % 9 / 3] = 0.0;
    } else if (i % 3 == 2) {
      colour = 2.0 * colour - Vector3d::Ones();
    }
    made.push_back(colour);
  }
  return made;
}

std::string pairName(const std::pair<std::string, std::string>& pair) {
  return pair.first + " -> " + pair.second;
}

/// Response of a pipeline to a reflectance on the domain, as RGB that the input side of `transform` stands for.
Vector3d inputRgb(const TransformSpec& spec, const SpectralTransform& transform,
                  const spectral::DomainSamples& reflectance) {
  const PreparedPipeline input = prepare(spec.input, spec.training, spec.standardObserver);
  const Vector3d response = input.curves.transpose() * reflectance.cwiseProduct(input.light);
  return transform.responseFromRgb().inverse() * response.cwiseQuotient(input.white);
}

/// What the output side makes of a reflectance, by the definition: CAT with the gain of `adaptation`, on XYZ.
Vector3d outputRgb(const TransformSpec& spec, const spectral::DomainSamples& reflectance) {
  const PreparedPipeline input = prepare(spec.input, spec.training, spec.standardObserver);
  const PreparedPipeline output = prepare(spec.output, spec.training, spec.standardObserver);
  const Matrix3d cones = spectral::lmsFromXyz(spec.cat);
  const Vector3d white = cones * spec.space.whiteXyz();
  const Vector3d gain = spec.adaptation * white.cwiseQuotient(cones * output.whiteXyz()) +
                        (1.0 - spec.adaptation) * white.cwiseQuotient(cones * input.whiteXyz());
  const Vector3d response = output.curves.transpose() * reflectance.cwiseProduct(output.light);
  const Vector3d xyz = cones.inverse() * (gain.asDiagonal() * (cones * (output.xyzFromResponse * response)));
  return spec.space.rgbFromXyz() * xyz;
}

TEST(SpectralTransformTest, IdentityCopiesExactly) {
  TransformSpec spec = specOf("HP1", "HP1");
  spec.adaptation = 0.7;  // both sides have the same white: nothing to adapt to
  const SpectralTransform transform(spec);
  EXPECT_TRUE(transform.isIdentity());
  EXPECT_EQ(transform.unconstrainedMatrix(), Matrix3d(Matrix3d::Identity()));
  std::vector<float> pixels{0.1F, -0.2F, 65504.0F, 0.5F, 1e-42F, 3e38F, -0.0F, 1.0F};
  const std::vector<float> before = pixels;
  transform.apply(pixels);
  EXPECT_EQ(pixels, before);
  for (const Vector3d& colour : colours(100)) {
    EXPECT_EQ(transform.apply(colour), colour);
    EXPECT_EQ(transform.linearise(colour).value, colour);
  }
  EXPECT_FALSE(SpectralTransform(specOf("D65", "HP1")).isIdentity());
}

TEST(SpectralTransformTest, OneThatIsAssignedIsTheOther) {
  SpectralTransform transform(specOf("HP1", "HP1"));
  transform = SpectralTransform(specOf("D65", "A"));
  EXPECT_FALSE(transform.isIdentity());
  const Vector3d colour(0.4, 0.2, 0.1);
  EXPECT_EQ(transform.apply(colour), SpectralTransform(specOf("D65", "A")).apply(colour));
}

TEST(SpectralTransformTest, KeptExposureOfTheSameFilterOnBothSidesIsIdentity) {
  TransformSpec spec = specOf("D65", "D65");
  const spectral::Spectrum gel = testLibrary().filter("ISO Standard Lens");
  spec.input.filters = {{gel, 1.0}};
  spec.output.filters = {{gel, 1.0}};
  spec.keepExposure = true;
  EXPECT_TRUE(SpectralTransform(spec).isIdentity());
}

TEST(SpectralTransformTest, WhiteGoesWhereAdaptationSays) {
  for (const auto& pair : lightPairs()) {
    spectral::MaxDifference kept(pairName(pair) + ": neutrals at D = 1", 1e-9);
    spectral::MaxDifference cast(pairName(pair) + ": white at any D", 1e-9);
    for (const auto cat : {spectral::ChromaticAdaptation::VonKries, spectral::ChromaticAdaptation::Bradford,
                           spectral::ChromaticAdaptation::Cat02, spectral::ChromaticAdaptation::Cat16}) {
      TransformSpec spec = specOf(pair.first, pair.second);
      spec.cat = cat;
      for (const double adaptation : {0.0, 0.25, 0.5, 1.0}) {
        spec.adaptation = adaptation;
        const SpectralTransform transform(spec);
        cast.add(transform.apply(Vector3d::Ones()), outputRgb(spec, spectral::DomainSamples::Ones()));
        if (adaptation == 1.0) {
          for (const double grey : {0.18, 1.0, 20.0}) {
            kept.add(transform.apply(Vector3d::Constant(grey)) / grey, Vector3d::Ones());
          }
        }
      }
      // D = 0: what an eye that stays with the input light sees of the new light.
      spec.adaptation = 0.0;
      const PreparedPipeline input = prepare(spec.input, {}, spec.standardObserver);
      const PreparedPipeline output = prepare(spec.output, {}, spec.standardObserver);
      const Vector3d seen = spec.space.rgbFromXyz() * spectral::adaptXyz(cat, input.whiteXyz(), spec.space.whiteXyz()) *
                            output.whiteXyz();
      cast.add(SpectralTransform(spec).apply(Vector3d::Ones()), seen);
    }
  }
}

TEST(SpectralTransformTest, WholeStopsAreExactAndOthersNearlySo) {
  for (const auto& pair : {lightPairs()[1], lightPairs()[5]}) {
    const SpectralTransform transform(specOf(pair.first, pair.second));
    spectral::MaxDifference difference(pairName(pair) + ": exposures of -20 to +20 stops", 1e-6);
    std::mt19937 random(5);
    for (const Vector3d& colour : colours(300)) {
      const Vector3d result = transform.apply(colour);
      for (const int stop : {-20, -7, -1, 1, 3, 20}) {
        ASSERT_EQ(transform.apply(std::ldexp(1.0, stop) * colour), Vector3d(std::ldexp(1.0, stop) * result))
            << pairName(pair) << ": " << colour.transpose();
      }
      const double exposure = std::exp2(40.0 * unitRandom(random) - 20.0);
      difference.add(transform.apply(exposure * colour) / (exposure * result.norm()), result / result.norm());
    }
  }
}

TEST(SpectralTransformTest, DefaultBandsAgainstConverged) {
  for (const auto& pair : lightPairs()) {
    const TransformSpec spec = specOf(pair.first, pair.second);
    const ErrorProtocol protocol(spec, chart());
    const SpectralTransform transform(spec);
    const ErrorProtocol::Report report = protocol.measure([&](std::span<float> rgba) { transform.apply(rgba); });
    std::printf("[ bands ] %s, %d bands: mean %.4f p99 %.4f max %.4f of %zu probes; worst %s\n", pairName(pair).c_str(),
                transform.bandCount(), report.mean, report.p99, report.max, report.count, report.worstProbe.c_str());
    EXPECT_LE(report.p99, 0.1) << pairName(pair);
    EXPECT_LE(report.max, 0.5) << pairName(pair);
    EXPECT_GE(report.count, 21U * 1024);
  }
}

TEST(SpectralTransformTest, BorderDoesNotDependOnTheBands) {
  // A line of emission at the end of the observer's range that is in at one number of bands and out at another moves
  // all colours beyond the border: daylight's probes, many of which no reflectance makes under these lights.
  const ErrorProtocol daylight(specOf("D65", "A"), chart());
  for (const char* const light : {"Mercury", "HP1"}) {
    const TransformSpec spec = specOf(light, "D65");
    const SpectralTransform transform(spec);
    const SpectralTransform converged(spec, kConvergedBandCount);
    const ErrorProtocol::Report report =
        daylight.measureAgainst(converged, [&](std::span<float> rgba) { transform.apply(rgba); });
    std::printf("[ bands ] %s -> D65: p99 %.4f max %.4f; worst %s\n", light, report.p99, report.max,
                report.worstProbe.c_str());
    EXPECT_LE(report.p99, 0.2) << light;
  }
}

TEST(SpectralTransformTest, InvertsItsOwnSpectrum) {
  const TransformSpec spec = specOf("D65", "HP1");
  const SpectralTransform transform(spec, kConvergedBandCount);
  spectral::MaxDifference in("input response of the reflectance", 1e-9);
  spectral::MaxDifference out("output of the reflectance", 1e-9);
  int inside = 0;
  for (const Vector3d& colour : colours(300)) {
    const auto reflectance = transform.reflectance(colour);
    ASSERT_EQ(reflectance.has_value(), transform.isFeasible(colour)) << colour.transpose();
    if (reflectance) {
      ++inside;
      EXPECT_GE(reflectance->minCoeff(), 0.0);
      in.add(inputRgb(spec, transform, *reflectance), colour);
      out.add(transform.apply(colour), outputRgb(spec, *reflectance));
    }
  }
  EXPECT_GT(inside, 50);
}

TEST(SpectralTransformTest, LinearisationIsTheDerivative) {
  const SpectralTransform transform(specOf("D65", "FL11"));
  SpectralTransform::Linearisation neighbour;
  // Two ways to the same solution, near the locus through systems that lose half the digits.
  spectral::MaxDifference value("linearised value", 1e-8);
  int unlike = 0;
  const auto all = colours(300);
  for (const Vector3d& colour : all) {
    const auto local = transform.linearise(colour);
    const double size = local.value.norm();
    value.add(local.value / size, transform.apply(colour) / size);
    const auto again = transform.linearise(colour, &neighbour.active);
    EXPECT_EQ(again.value, local.value) << colour.transpose();
    EXPECT_EQ(again.active, local.active) << colour.transpose();
    neighbour = local;
    const Vector3d step = 1e-7 * Vector3d(1, -2, 3);
    const Vector3d change = transform.apply(colour + step) - transform.apply(colour - step);
    // A kink between the two points is where they may differ; few are that close to one.
    unlike += (change - 2.0 * local.matrix * step).norm() > 1e-6 * change.norm() + 1e-13 ? 1 : 0;
  }
  EXPECT_LE(unlike, static_cast<int>(all.size()) / 50);
}

TEST(SpectralTransformTest, LinearConeIsTheUnconstrainedMatrix) {
  for (const auto& pair : lightPairs()) {
    const SpectralTransform transform(specOf(pair.first, pair.second));
    const std::vector<Vector3d> corners = transform.linearConeCorners();
    ASSERT_GE(corners.size(), 3U) << pairName(pair);
    spectral::MaxDifference difference(pairName(pair) + ": matrix inside the linear cone", 1e-9);
    std::mt19937 random(9);
    for (int i = 0; i < 200; ++i) {
      Vector3d mixture = Vector3d::Zero();
      for (const Vector3d& corner : corners) {
        mixture += unitRandom(random) / corner.norm() * corner;
      }
      const Vector3d result = transform.apply(mixture);
      difference.add(transform.unconstrainedMatrix() * mixture / result.norm(), result / result.norm());
    }
  }
}

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

TEST(SpectralTransformTest, ErrorsNameWhatGivesNoLight) {
  const spectral::Spectrum opaque("black tape", spectral::SpectralQuantity::Transmittance, {400.0, 700.0}, {0.0, 0.0});
  TransformSpec spec = specOf("D65", "A");
  spec.output.filters = {{opaque, 1.0}};
  EXPECT_EQ(errorOf([&] { SpectralTransform transform(spec); }),
            "A through black tape: filters '1': the filters stop all the light; lower a density or take one away");
  spec.output.filters = {{opaque, 0.0}};
  EXPECT_EQ(errorOf([&] { SpectralTransform transform(spec); }), "no InputError");
  spec.output.filters = {{opaque, -1.0}};
  EXPECT_NE(errorOf([&] { SpectralTransform transform(spec); }).find("black tape: density '-1"), std::string::npos);

  spec = specOf("D65", "A");
  spec.input.illuminant =
      spectral::Spectrum("infrared", spectral::SpectralQuantity::SpectralPowerDistribution, {800.0, 900.0}, {1.0, 1.0});
  EXPECT_EQ(errorOf([&] { SpectralTransform transform(spec); }),
            "infrared: illuminant 'CIE 1931 2': this light gives this observer nothing between 380 and 780 nm");
  spec = specOf("D65", "A");
  spec.adaptation = kNan;
  EXPECT_NE(errorOf([&] { SpectralTransform transform(spec); }).find("adaptation"), std::string::npos);
  spec = specOf("D65", "A");
  spec.output.observer = testLibrary().observer("Nikon D5100");
  EXPECT_NE(errorOf([&] { SpectralTransform transform(spec); }).find("training"), std::string::npos);
}

TEST(SpectralTransformTest, AChannelThatTheLightLeavesDarkIsRefused) {
  // Low-pressure sodium, one line at 590 nm, where the blue curve of CIE 1964 is zero: no white to normalise by.
  TransformSpec spec = specOf("LPS", "D65");
  spec.input.observer = testLibrary().observer("CIE 1964 10");
  const std::string error = errorOf([&] { SpectralTransform transform(spec); });
  EXPECT_NE(error.find("LPS"), std::string::npos) << error;
  EXPECT_NE(error.find("CIE 1964 10"), std::string::npos) << error;
  // As the output it is a light like any other.
  spec = specOf("D65", "LPS");
  spec.output.observer = testLibrary().observer("CIE 1964 10");
  EXPECT_TRUE(SpectralTransform(spec).apply(Eigen::Vector3d(0.2, 0.5, 0.3)).allFinite());
}

TEST(SpectralTransformTest, PipelinesWithoutOverlap) {
  TransformSpec spec = specOf("D65", "D65");
  const auto power = spectral::SpectralQuantity::SpectralPowerDistribution;
  spec.input.illuminant = spectral::Spectrum("blue half", power, {380.0, 480.0, 490.0}, {1.0, 1.0, 0.0});
  spec.output.illuminant = spectral::Spectrum("red half", power, {600.0, 610.0, 780.0}, {0.0, 1.0, 1.0});
  const SpectralTransform transform(spec);
  const auto diagnostics = transform.diagnostics();
  double gain = 0.0;
  for (const Vector3d& colour : colours(500)) {
    const Vector3d result = transform.apply(colour);
    ASSERT_TRUE(result.allFinite()) << colour.transpose();
    gain = std::max(gain, result.norm() / colour.norm());
  }
  std::printf("[ no overlap ] rank %d, condition %.3g, matrix gain %.3g, largest gain %.3g\n", diagnostics.rank,
              diagnostics.conditionNumber, diagnostics.matrixGain, gain);
  EXPECT_LT(gain, 10'000.0);
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

TEST(SpectralTransformTest, FiltersStackByDensity) {
  const spectral::Spectrum gel = testLibrary().filter("Lee 204 Full C.T. Orange");
  TransformSpec twoSheets = specOf("D65", "D65");
  twoSheets.output.filters = {{gel, 1.0}, {gel, 1.0}};
  TransformSpec thick = specOf("D65", "D65");
  thick.output.filters = {{gel, 2.0}};
  const SpectralTransform a(twoSheets);
  const SpectralTransform b(thick);
  spectral::MaxDifference difference("density 2 and two sheets", 1e-12);
  for (const Vector3d& colour : colours(300)) {
    difference.add(a.apply(colour), b.apply(colour));
  }
  // Two halves are the whole, and none is nothing.
  thick.output.filters = {{gel, 0.5}, {gel, 0.5}};
  TransformSpec one = specOf("D65", "D65");
  one.output.filters = {{gel, 1.0}};
  const SpectralTransform c(thick);
  const SpectralTransform d(one);
  for (const Vector3d& colour : colours(300)) {
    difference.add(c.apply(colour), d.apply(colour));
  }
  thick.output.filters = {{gel, 0.0}};
  EXPECT_TRUE(SpectralTransform(thick).isIdentity());
  // The gel on both sides changes nothing, whatever the rest.
  thick.input.filters = {{gel, 1.5}};
  thick.output.filters = {{gel, 1.5}};
  EXPECT_TRUE(SpectralTransform(thick).isIdentity());
}

TEST(SpectralTransformTest, KeptExposureKeepsTheLossOfAFilter) {
  const spectral::Spectrum gel = testLibrary().filter("Lee 204 Full C.T. Orange");
  const spectral::DomainSamples light = testLibrary().illuminant("D65").onDomain();
  const spectral::DomainSamples luminosity = testLibrary().observer("CIE 1931 2").onDomain().col(1);
  const double transmission = light.cwiseProduct(gel.onDomain()).dot(luminosity) / light.dot(luminosity);
  for (const bool onInput : {false, true}) {
    TransformSpec spec = specOf("D65", "D65");
    (onInput ? spec.input : spec.output).filters = {{gel, 1.0}};
    const SpectralTransform evened(spec);
    spec.keepExposure = true;
    const SpectralTransform kept(spec);
    const double expected = onInput ? 1.0 / transmission : transmission;
    const Eigen::RowVector3d luminance = spec.space.xyzFromRgb().row(1);
    spectral::MaxDifference difference(onInput ? "exposure won" : "exposure lost", 1e-12);
    for (const Vector3d& colour : colours(100)) {
      difference.add(kept.apply(colour), expected * evened.apply(colour));
    }
    if (!onInput) {
      // With the eye on the input light, luminance tells the loss: white's Y is 1 without the filter's.
      EXPECT_NEAR(luminance.dot(kept.apply(Vector3d::Ones())) / luminance.dot(evened.apply(Vector3d::Ones())),
                  transmission, 1e-12);
    }
  }
}

TEST(SpectralTransformTest, CamerasBothWays) {
  for (const char* const camera : {"Nikon D5100", "Canon EOS 5D Mark II", "ACES RICD"}) {
    for (const bool cameraOut : {true, false}) {
      TransformSpec spec = specOf("D65", "D65");
      spec.training = samplesOf("rawtoaces 190");
      (cameraOut ? spec.output : spec.input).observer = testLibrary().observer(camera);
      spec.adaptation = 1.0;
      const SpectralTransform transform(spec, 81);
      EXPECT_FALSE(transform.isIdentity());
      EXPECT_LE((transform.apply(Vector3d::Ones()) - Vector3d::Ones()).norm(), 1e-9) << camera;
      double largest = 0.0;
      for (const spectral::DomainSamples& patch : samplesOf("colorchecker")) {
        const Vector3d rgb = inputRgb(spec, transform, patch);
        const Matrix3d xyz = spec.space.xyzFromRgb();
        const Vector3d white = spec.space.whiteXyz();
        largest = std::max(largest, spectral::deltaE2000(spectral::lab(xyz * rgb, white),
                                                         spectral::lab(xyz * transform.apply(rgb), white)));
      }
      std::printf("[ camera ] %s as %s: chart patches move by at most %.2f CIEDE2000\n", camera,
                  cameraOut ? "output" : "input", largest);
      // A camera with a matrix sees nearly what the eye sees.
      EXPECT_LT(largest, 12.0) << camera;
      for (const Vector3d& colour : colours(200)) {
        ASSERT_TRUE(transform.apply(colour).allFinite()) << camera << ": " << colour.transpose();
      }
    }
    TransformSpec same = specOf("D65", "D65");
    same.training = samplesOf("rawtoaces 190");
    same.input.observer = testLibrary().observer(camera);
    same.output.observer = same.input.observer;
    EXPECT_TRUE(SpectralTransform(same, 81).isIdentity()) << camera;
  }
}

/// A patch's own spectrum on both sides, against the transform.
double largestPatchError(const TransformSpec& spec, const std::string& set) {
  const SpectralTransform transform(spec, kConvergedBandCount);
  double largest = 0.0;
  for (const spectral::DomainSamples& patch : samplesOf(set)) {
    const Vector3d expected = outputRgb(spec, patch);
    largest =
        std::max(largest, (transform.apply(inputRgb(spec, transform, patch)) - expected).norm() / expected.norm());
  }
  return largest;
}

TEST(SpectralTransformTest, ADatasetGivesItsOwnPatchesExactly) {
  for (const auto& pair : lightPairs()) {
    TransformSpec spec = specOf(pair.first, pair.second);
    spec.scene.kind = ReferenceScene::Kind::Dataset;
    // Patches far apart in chromaticity: near ones are averaged. The chart's neutrals are left out, because a neutral
    // is the perfect reflector.
    const auto all = samplesOf("colorchecker");
    spec.scene.samples.assign(all.begin(), all.begin() + 18);
    const SpectralTransform transform(spec, kConvergedBandCount);
    const double margin = 3e-3;  // the hull is drawn in by a thousandth of the way to white
    double onHull = 0.0;
    double inside = 0.0;
    int insideCount = 0;
    for (const spectral::DomainSamples& patch : spec.scene.samples) {
      const Vector3d rgb = inputRgb(spec, transform, patch);
      const Vector3d expected = outputRgb(spec, patch);
      const double error = (transform.apply(rgb) - expected).norm() / expected.norm();
      if (transform.isFeasible(rgb)) {
        inside = std::max(inside, error);
        ++insideCount;
      } else {
        onHull = std::max(onHull, error);
      }
    }
    std::printf("[ dataset ] %s: %d patches inside within %.2g, those on the hull within %.2g\n",
                pairName(pair).c_str(), insideCount, inside, onHull);
    EXPECT_LE(inside, 1e-9) << pairName(pair);
    EXPECT_GE(insideCount, 6) << pairName(pair);
    EXPECT_LE(onHull, margin) << pairName(pair);
    for (const Vector3d& colour : colours(200)) {
      ASSERT_TRUE(transform.apply(colour).allFinite()) << pairName(pair);
    }
    EXPECT_TRUE(transform.linearConeCorners().empty());
  }
}

TEST(SpectralTransformTest, PriorRunsFromSmoothToTheChart) {
  const auto& pair = lightPairs()[1];
  TransformSpec spec = specOf(pair.first, pair.second);
  const SpectralTransform smooth(spec, 81);
  const double smoothError = largestPatchError(spec, "colorchecker");
  spec.scene = {ReferenceScene::Kind::Prior, samplesOf("colorchecker"), 0.0, 0.04};
  const SpectralTransform none(spec, 81);
  spectral::MaxDifference difference("prior of strength 0 and smooth", 1e-9);
  for (const Vector3d& colour : colours(200)) {
    const Vector3d expected = smooth.apply(colour);
    difference.add(none.apply(colour) / expected.norm(), expected / expected.norm());
  }
  double before = smoothError;
  for (const double strength : {0.5, 1.0}) {
    spec.scene.strength = strength;
    spec.scene.radius = 0.005;  // so narrow that each patch is alone
    const double error = largestPatchError(spec, "colorchecker");
    std::printf("[ prior ] %s, strength %.1f: chart patches within %.4f, smooth %.4f\n", pairName(pair).c_str(),
                strength, error, smoothError);
    EXPECT_LT(error, before);
    before = error;
  }
  EXPECT_LT(before, 0.05);
  // Continuous and homogeneous with the blend too.
  const SpectralTransform prior(spec, 81);
  for (const Vector3d& colour : colours(100)) {
    const Vector3d result = prior.apply(colour);
    ASSERT_TRUE(result.allFinite());
    EXPECT_EQ(prior.apply(1024.0 * colour), Vector3d(1024.0 * result));
    EXPECT_LE((prior.apply(colour + 1e-9 * Vector3d(1, -1, 1)) - result).norm(), 1e-6) << colour.transpose();
  }
  EXPECT_TRUE(prior.linearConeCorners().empty());
}

TEST(SpectralTransformTest, ScenesNeedSamplesAndThreeChannels) {
  TransformSpec spec = specOf("D65", "A");
  spec.scene.kind = ReferenceScene::Kind::Prior;
  EXPECT_NE(errorOf([&] { SpectralTransform transform(spec); }).find("scene.set"), std::string::npos);
  spec.scene.samples = samplesOf("skin");
  spec.scene.strength = kNan;
  EXPECT_NE(errorOf([&] { SpectralTransform transform(spec); }).find("strength"), std::string::npos);
  spec.scene.strength = 1.0;
  spec.scene.radius = 0.0;
  EXPECT_NE(errorOf([&] { SpectralTransform transform(spec); }).find("radius"), std::string::npos);
  spec = specOf("LPS", "D65");
  spec.scene = {ReferenceScene::Kind::Dataset, samplesOf("skin"), 1.0, 0.04};
  EXPECT_NE(errorOf([&] { SpectralTransform transform(spec); }).find("use scene kind smooth"), std::string::npos);
}

TEST(SpectralTransformTest, AnyBandCount) {
  const TransformSpec spec = specOf("D65", "HP1");
  for (const int bands : {kMinimumBandCount, 7, 16, 41, 81, 128, kConvergedBandCount}) {
    const SpectralTransform transform(spec, bands);
    EXPECT_EQ(transform.bandCount(), bands);
    for (const Vector3d& colour : colours(100)) {
      ASSERT_TRUE(transform.apply(colour).allFinite()) << bands << ": " << colour.transpose();
    }
    EXPECT_LE((transform.apply(Vector3d::Ones()) - outputRgb(spec, spectral::DomainSamples::Ones())).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace metamer::sip
