// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/homogeneous_map.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>
#include <numbers>
#include <random>
#include <thread>
#include <vector>

#include "metamer/sip/error_protocol.h"
#include "metamer/sip/scene_cache.h"
#include "sip/sip_fixture.h"

namespace metamer::sip {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// One map for the tests that need any: spiky light, kinks, a linear cone.
const HomogeneousMap& sodiumMap() {
  static const HomogeneousMap map = buildHomogeneousMap(SpectralTransform(specOf("D65", "HP1")));
  return map;
}

/// Pixels of every kind that is finite: natural, saturated, negative, of any exposure.
std::vector<float> pixelsOf(std::size_t count) {
  std::mt19937 random(11);
  const auto uniform = [&random] { return static_cast<float>(unitRandom(random)); };
  std::vector<float> pixels;
  for (std::size_t i = 0; i < count; ++i) {
    const float exposure = std::exp2(12.0F * uniform() - 6.0F);
    const float low = i % 4 == 3 ? -1.0F : i % 4 == 2 ? 0.0F : 0.3F;
    for (int k = 0; k < 3; ++k) {
      pixels.push_back(exposure * (low + (1.0F - low) * uniform()));
    }
    pixels.push_back(uniform());
  }
  return pixels;
}

void expectSameBits(std::span<const float> a, std::span<const float> b, const std::string& what) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(std::bit_cast<std::uint32_t>(a[i]), std::bit_cast<std::uint32_t>(b[i])) << what << ", float " << i;
  }
}

TEST(HomogeneousMapTest, AgainstItsTransform) {
  for (const auto& [inputLight, outputLight] : lightPairs()) {
    std::string name = inputLight;
    name.append(" -> ").append(outputLight);
    const TransformSpec spec = specOf(inputLight, outputLight);
    const SpectralTransform transform(spec, 81);
    const std::clock_t start = std::clock();
    const HomogeneousMap map = buildHomogeneousMap(transform);
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    const auto report =
        ErrorProtocol(spec, chart()).measureAgainst(transform, [&](std::span<float> rgba) { map.apply(rgba); });
    std::printf(
        "[ map ] %s: mean %.4f p99 %.4f max %.4f of %zu probes; worst %s; built in %.2f s of processor time, %d "
        "solves, "
        "%d patches\n",
        name.c_str(), report.mean, report.p99, report.max, report.count, report.worstProbe.c_str(), seconds,
        map.statistics.solves, map.statistics.patches);
    EXPECT_LE(report.p99, 0.1) << name;
    EXPECT_LE(report.max, 1.0) << name;
    EXPECT_GT(map.linearNormalCount, 0) << name;
  }
}

TEST(HomogeneousMapTest, CamerasTakeNoMoreThanEyes) {
  for (const char* const camera : {"Nikon D5100", "Canon EOS 5D Mark II", "ACES RICD"}) {
    TransformSpec spec = specOf("D65", "A");
    spec.input.observer = testLibrary().observer(camera);
    spec.training = samplesOf("rawtoaces 190");
    const HomogeneousMap map = buildHomogeneousMap(SpectralTransform(spec));
    std::printf("[ map ] seen by %s: %d solves, %d patches\n", camera, map.statistics.solves, map.statistics.patches);
    // The hardest pair of lights takes 84,000 with an eye.
    EXPECT_LT(map.statistics.solves, 100'000) << camera;
  }
}

TEST(HomogeneousMapTest, BuildIsTheSameOnManyThreads) {
  const SpectralTransform transform(specOf("D65", "HP1"));
  const HomogeneousMap again =
      buildHomogeneousMap(transform, kDefaultMapTolerance, [](int count, const std::function<void(int)>& body) {
        std::vector<std::jthread> threads;
        threads.reserve(3);
        for (int thread = 0; thread < 3; ++thread) {
          threads.emplace_back([&body, count, thread] {
            for (int i = count - 1 - thread; i >= 0; i -= 3) {
              body(i);
            }
          });
        }
      });
  EXPECT_EQ(again.faceOffset, sodiumMap().faceOffset);
  EXPECT_EQ(again.statistics.solves, sodiumMap().statistics.solves);
  EXPECT_EQ(again.patchIndex, sodiumMap().patchIndex);
  EXPECT_EQ(again.roots, sodiumMap().roots);
  ASSERT_EQ(again.patches.size(), sodiumMap().patches.size());
  for (std::size_t i = 0; i < again.patches.size(); ++i) {
    expectSameBits(again.patches[i].coefficients, sodiumMap().patches[i].coefficients, "patch " + std::to_string(i));
  }
}

TEST(HomogeneousMapTest, ExposureInvariant) {
  // Pixels of 12 bits times exposures of 12 are floats without rounding: what differs is the map's own doing.
  const auto shortened = [](double value) {
    int exponent = 0;
    const double mantissa = std::frexp(value, &exponent);
    return std::ldexp(std::round(4096.0 * mantissa), exponent - 12);
  };
  std::vector<float> pixels = pixelsOf(16384);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    pixels[i] = i % 4 == 3 ? 1.0F : static_cast<float>(shortened(pixels[i]));
  }
  for (const auto& [inputLight, outputLight] : lightPairs()) {
    const HomogeneousMap map = buildHomogeneousMap(SpectralTransform(specOf(inputLight, outputLight), 81));
    std::vector<float> expected(pixels.size());
    map.apply(pixels, expected);
    double largest = 0.0;
    for (int step = -40; step <= 40; ++step) {
      const double exposure = shortened(std::exp2(0.5 * step + (step % 3 == 0 ? 0.0 : 0.1373)));
      std::vector<float> scaled = pixels;
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        scaled[i] = static_cast<float>(exposure * pixels[i]);
      }
      map.apply(scaled);
      for (std::size_t i = 0; i < pixels.size(); i += 4) {
        double size = 0.0;
        double difference = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
          size = std::max(size, static_cast<double>(std::abs(expected[i + k])));
          difference = std::max(difference, std::abs(scaled[i + k] / exposure - expected[i + k]));
        }
        largest = std::max(largest, difference / size);
      }
    }
    std::printf("[ map ] %s -> %s: exposures of -20 to +20 stops differ by at most %.2g of the pixel\n",
                inputLight.c_str(), outputLight.c_str(), largest);
    EXPECT_LE(largest, 1e-6) << inputLight << " -> " << outputLight;
  }
}

TEST(HomogeneousMapTest, WholeStopsAreExact) {
  const std::vector<float> pixels = pixelsOf(1024);
  std::vector<float> expected(pixels.size());
  sodiumMap().apply(pixels, expected);
  for (const int stop : {-20, -3, 1, 20}) {
    std::vector<float> scaled = pixels;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      scaled[i] = i % 4 == 3 ? pixels[i] : std::ldexp(pixels[i], stop);
    }
    sodiumMap().apply(scaled);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      ASSERT_EQ(scaled[i], i % 4 == 3 ? pixels[i] : std::ldexp(expected[i], stop)) << stop << " stops, float " << i;
    }
  }
}

TEST(HomogeneousMapTest, SplitsTailsAndPlaceDoNotMatter) {
  const std::vector<float> pixels = pixelsOf(203);
  std::vector<float> whole(pixels.size());
  sodiumMap().apply(pixels, whole);
  std::vector<float> inPlace = pixels;
  sodiumMap().apply(inPlace);
  expectSameBits(inPlace, whole, "in place");
  std::vector<float> one = pixels;
  for (std::size_t i = 0; i < one.size(); i += 4) {
    sodiumMap().apply(std::span(one).subspan(i, 4));
  }
  expectSameBits(one, whole, "a pixel at a time");
  for (std::size_t length = 2; length <= 67; ++length) {
    std::vector<float> split(pixels.size(), -1.0F);
    for (std::size_t i = 0; i < pixels.size(); i += 4 * length) {
      const std::size_t count = std::min(4 * length, pixels.size() - i);
      sodiumMap().apply(std::span(pixels).subspan(i, count), std::span(split).subspan(i, count));
    }
    expectSameBits(split, whole, std::to_string(length) + " pixels at a time");
  }
  // Off any alignment but a float's.
  std::vector<float> shifted(pixels.size() + 1);
  std::copy(pixels.begin(), pixels.end(), shifted.begin() + 1);
  sodiumMap().apply(std::span(shifted).subspan(1));
  expectSameBits(std::span(shifted).subspan(1), whole, "shifted by a float");
  sodiumMap().apply(std::span<float>());
}

TEST(HomogeneousMapTest, DoesNotWriteBeyondTheSpan) {
  for (std::size_t count = 0; count < 40; ++count) {
    std::vector<float> pixels = pixelsOf(count + 20);
    const std::vector<float> before = pixels;
    sodiumMap().apply(std::span(pixels).first(4 * count));
    expectSameBits(std::span(pixels).subspan(4 * count), std::span(before).subspan(4 * count), "rest");
  }
}

TEST(HomogeneousMapTest, OddPixelsStayAndSpareTheirNeighbours) {
  const std::vector<float> clean = pixelsOf(64);
  std::vector<float> expected(clean.size());
  sodiumMap().apply(clean, expected);
  for (const float odd : {kNan, -kNan, kInfinity, -kInfinity}) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t place = 0; place < 64; ++place) {
        std::vector<float> pixels = clean;
        pixels[4 * place + k] = odd;
        std::vector<float> wanted = expected;
        std::copy_n(pixels.begin() + static_cast<std::ptrdiff_t>(4 * place), 4,
                    wanted.begin() + static_cast<std::ptrdiff_t>(4 * place));
        sodiumMap().apply(pixels);
        expectSameBits(pixels, wanted, "odd pixel " + std::to_string(place));
      }
    }
  }
}

TEST(HomogeneousMapTest, AlphaIsUntouched) {
  std::vector<float> pixels = pixelsOf(64);
  const std::vector<float> alphas{0.0F, -0.0F, 1.0F, -2.0F, kNan, -kNan, kInfinity, -kInfinity, 1e-42F, 65504.0F};
  std::vector<float> colours(pixels.size());
  sodiumMap().apply(pixels, colours);
  for (std::size_t i = 0; i < 64; ++i) {
    pixels[4 * i + 3] = alphas[i % alphas.size()];
    colours[4 * i + 3] = alphas[i % alphas.size()];
  }
  sodiumMap().apply(pixels);
  expectSameBits(pixels, colours, "any alpha");
}

TEST(HomogeneousMapTest, HardPixelsAreFiniteAndCloseToTheTransform) {
  for (const auto& [inputLight, outputLight] : lightPairs()) {
    const SpectralTransform transform(specOf(inputLight, outputLight), 81);
    const HomogeneousMap map = buildHomogeneousMap(transform);
    for (const float size : {1e30F, 65504.0F, 1.0F, 1e-30F, 1e-38F, 1e-42F, std::numeric_limits<float>::denorm_min()}) {
      std::vector<float> pixels;
      for (const Eigen::Vector3f& direction : std::vector<Eigen::Vector3f>{{1, 1, 1},
                                                                           {1, 0, 0},
                                                                           {0, 1, 0},
                                                                           {0, 0, 1},
                                                                           {-1, -1, -1},
                                                                           {-1, 1, -1},
                                                                           {1, -1, 1},
                                                                           {1, 1, 0},
                                                                           {0, 0, -1},
                                                                           {1, -1, 0},
                                                                           {0.2F, 0.9F, -0.3F},
                                                                           {0, 0, 0},
                                                                           {-0.0F, -0.0F, -0.0F}}) {
        for (int k = 0; k < 3; ++k) {
          pixels.push_back(size * direction[k]);
        }
        pixels.push_back(1.0F);
      }
      std::vector<float> results(pixels.size());
      map.apply(pixels, results);
      for (std::size_t i = 0; i < pixels.size(); i += 4) {
        const Eigen::Map<const Eigen::Vector3f> result(results.data() + i);
        const Eigen::Map<const Eigen::Vector3f> given(pixels.data() + i);
        ASSERT_TRUE(result.allFinite()) << inputLight << " -> " << outputLight << ": " << given.transpose();
        const Eigen::Vector3d exact = transform.apply(Eigen::Vector3d(given.cast<double>()));
        // Beyond all lights the patches are coarse: a part of the pixel's own size, of which a dim result may be less.
        // Denormals keep fewer digits than that.
        EXPECT_LE((result.cast<double>() - exact).norm(), 0.05 * given.cast<double>().norm() + 1e-37)
            << inputLight << " -> " << outputLight << ": " << given.transpose();
        if (given.isZero(0.0F)) {
          EXPECT_TRUE(result.isZero(0.0F));
        }
      }
    }
  }
}

TEST(HomogeneousMapTest, SeamsStayWithinTheTolerance) {
  // Chromaticities along lines between saturated colours, in steps of 1e-5. Patches of one
  // size share their edges; where sizes differ, either side may be off by the tolerance: 0.09 CIEDE2000 at Y = 0.18 is
  // 0.4 % of the luminance, so two sides differ by less than 1 % of the pixel.
  const std::vector<Eigen::Vector3d> ends{{1, 0.1, 0.1}, {0.1, 1, 0.1}, {0.1, 0.1, 1}, {1, 0.1, 0.1}, {1, 1, 0.05}};
  double largest = 0.0;
  for (std::size_t leg = 0; leg + 1 < ends.size(); ++leg) {
    constexpr int kSteps = 100'000;
    std::vector<float> pixels;
    for (int i = 0; i <= kSteps; ++i) {
      const double share = static_cast<double>(i) / kSteps;
      const Eigen::Vector3d colour = (1.0 - share) * ends[leg] + share * ends[leg + 1];
      for (int k = 0; k < 3; ++k) {
        pixels.push_back(static_cast<float>(colour[k]));
      }
      pixels.push_back(1.0F);
    }
    sodiumMap().apply(pixels);
    for (std::size_t i = 4; i < pixels.size(); i += 4) {
      const Eigen::Map<const Eigen::Vector3f> a(pixels.data() + i - 4);
      const Eigen::Map<const Eigen::Vector3f> b(pixels.data() + i);
      largest = std::max(largest, static_cast<double>((a - b).norm() / a.norm()));
    }
  }
  std::printf("[ map ] largest change in a step of 1e-5: %.2g of the pixel\n", largest);
  EXPECT_LE(largest, 0.01);
}

TEST(HomogeneousMapTest, IdentityCopies) {
  const HomogeneousMap map = buildHomogeneousMap(SpectralTransform(specOf("FL11", "FL11")));
  EXPECT_TRUE(map.identity);
  std::vector<float> pixels = pixelsOf(37);
  pixels[5] = kNan;
  pixels[9] = -kInfinity;
  pixels[12] = 1e-42F;
  const std::vector<float> before = pixels;
  std::vector<float> copy(pixels.size());
  map.apply(pixels, copy);
  expectSameBits(copy, before, "copy");
  map.apply(pixels);
  expectSameBits(pixels, before, "in place");
}

TEST(HomogeneousMapTest, LightsThatTellFewChannelsApart) {
  for (const char* const light : {"LPS", "HPS"}) {
    const SpectralTransform transform(specOf(light, "D65"), 81);
    const HomogeneousMap map = buildHomogeneousMap(transform);
    std::vector<float> pixels = pixelsOf(2000);
    map.apply(pixels);
    for (const float value : pixels) {
      ASSERT_TRUE(std::isfinite(value)) << light;
    }
  }
}

TEST(HomogeneousMapTest, FewerLevelsCostLittleOnSurfacesAndSaveMuch) {
  const SpectralTransform transform(naturalSpecOf("FL11", "D50"), 41);
  const HomogeneousMap whole = buildHomogeneousMap(transform, 0.35);
  const HomogeneousMap coarse = buildHomogeneousMap(transform, 0.35, inOrder, nullptr, 3);
  float finest = 0.0F;
  for (const HomogeneousMap::Patch& patch : coarse.patches) {
    finest = std::max(finest, patch.scale);
  }
  EXPECT_LE(finest, static_cast<float>(HomogeneousMap::kFineSide));
  EXPECT_LT(2 * coarse.statistics.solves, whole.statistics.solves);
  std::mt19937 random(11);
  std::vector<double> errors;
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector3d rgb(0.1 + 0.9 * unitRandom(random), 0.1 + 0.9 * unitRandom(random),
                              0.1 + 0.9 * unitRandom(random));
    std::array<float, 4> pixel = {static_cast<float>(rgb.x()), static_cast<float>(rgb.y()), static_cast<float>(rgb.z()),
                                  1.0F};
    coarse.apply(pixel);
    const Eigen::Vector3d truth = transform.apply(rgb);
    errors.push_back((Eigen::Map<const Eigen::Vector3f>(pixel.data()).cast<double>() - truth).norm() / truth.norm());
  }
  std::sort(errors.begin(), errors.end());
  const double p99 = errors[errors.size() * 99 / 100];
  std::printf("[ map ] three levels fewer: %d of %d solves, surfaces p99 %.4f of a pixel\n", coarse.statistics.solves,
              whole.statistics.solves, p99);
  EXPECT_LE(p99, 0.01);
}

TEST(HomogeneousMapTest, ADraftSolvesItsCornersAndIsExactThere) {
  const SpectralTransform transform(naturalSpecOf("FL11", "D50"), 41);
  const HomogeneousMap draft = buildHomogeneousMap(transform, 100.0, inOrder, nullptr, HomogeneousMap::kMaximumDepth);
  // Of the front face 16 by 16 cells, of the other five 4 by 4: each corner once.
  EXPECT_EQ(draft.statistics.solves, 17 * 17 + 5 * 5 * 5);
  EXPECT_EQ(draft.statistics.patches, 16 * 16 + 5 * 4 * 4);
  const Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>> cubeFromRgb(draft.cubeFromRgb.data());
  const Eigen::Matrix3d rgbFromCube = cubeFromRgb.cast<double>().inverse();
  for (int face = 0; face < HomogeneousMap::kFaceCount; ++face) {
    for (int i = 0; i <= 4; ++i) {
      for (int j = 0; j <= 4; ++j) {
        Eigen::Vector3d cube;
        cube[face / 2] = face % 2 == 0 ? 1.0 : -1.0;
        cube[(face / 2 + 1) % 3] = 0.5 * i - 1.0;
        cube[(face / 2 + 2) % 3] = 0.5 * j - 1.0;
        const Eigen::Vector3f rgb = (rgbFromCube * cube).cast<float>();
        std::array<float, 4> pixel = {rgb.x(), rgb.y(), rgb.z(), 1.0F};
        draft.apply(pixel);
        const Eigen::Vector3d truth = transform.apply(rgb.cast<double>());
        const Eigen::Vector3d found = Eigen::Map<const Eigen::Vector3f>(pixel.data()).cast<double>();
        // Floats, and corners of a patch that they lie beside by as much.
        EXPECT_LE((found - truth).norm(), 1e-4 * truth.norm()) << "face " << face << ", " << i << ", " << j;
      }
    }
  }
}

TEST(HomogeneousMapTest, MemoryChangesNoMap) {
  SceneCache cache;
  const MapMemory memory;
  const auto build = [&](const TransformSpec& spec, bool remembers) {
    const SpectralTransform transform(spec, 41, &cache);
    return buildHomogeneousMap(transform, 0.5, inOrder, remembers ? &memory : nullptr);
  };
  // Another output, adaptation, and input; and back.
  TransformSpec adapted = naturalSpecOf("D65", "A");
  adapted.adaptation = 0.7;
  for (const TransformSpec& spec : {naturalSpecOf("D65", "A"), adapted, naturalSpecOf("D65", "FL11"),
                                    naturalSpecOf("A", "D65"), naturalSpecOf("D65", "A"), specOf("D65", "A")}) {
    const HomogeneousMap expected = build(spec, false);
    const HomogeneousMap found = build(spec, true);
    EXPECT_EQ(found.roots, expected.roots);
    EXPECT_EQ(found.patchIndex, expected.patchIndex);
    EXPECT_EQ(found.fine, expected.fine);
    ASSERT_EQ(found.patches.size(), expected.patches.size());
    for (std::size_t k = 0; k < found.patches.size(); ++k) {
      ASSERT_EQ(found.patches[k].coefficients, expected.patches[k].coefficients);
    }
  }
}

}  // namespace
}  // namespace metamer::sip
