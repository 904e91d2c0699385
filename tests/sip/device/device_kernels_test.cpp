// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/device_kernels.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "sip/device/device_fixture.h"
#include "sip/device/egl_device.h"
#include "sip/device/metal_text.h"
#include "sip/device/opencl_device.h"

namespace metamer::sip {
namespace {

/// Pixels a map: two million in all, or each in a long run.
std::size_t pixelCount() {
  return std::getenv("METAMER_LONG") != nullptr ? 2'000'000 : 2'000'000 / deviceCases().size();
}

/// Runs every map over pixels of every kind and expects the bits of the map's own kernel.
template <typename Run>
void expectTheBitsOfTheMap(std::size_t count, const Run& run) {
  ASSERT_EQ(deviceCases().size(), 12U);
  unsigned seed = 1;
  for (const DeviceCase& each : deviceCases()) {
    const std::vector<float> pixels = pixelsOfEveryKind(count, seed++);
    std::vector<float> expected(pixels.size());
    each.map.apply(pixels, expected);
    const std::vector<float> given = run(each.tables, pixels);
    std::string first;
    EXPECT_EQ(differingBits(expected, given, first), 0U) << each.name << ": " << first;
  }
}

/// What doubles make of a pixel; `room` is what three roundings of sums of such terms may take.
Eigen::Vector3d affine(const AffineForm& form, std::span<const float> pixel, double& room) {
  const Eigen::Vector3d colour(pixel[0], pixel[1], pixel[2]);
  const auto matrix = Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(form.matrix.data()).cast<double>();
  const auto offset = Eigen::Map<const Eigen::Vector3f>(form.offset.data()).cast<double>();
  room = 3.0 * 6e-8 * (matrix.cwiseAbs() * colour.cwiseAbs() + offset.cwiseAbs()).maxCoeff();
  const Eigen::Vector3d result = matrix * colour + offset;
  return form.clampsBelow ? result.cwiseMax(0.0) : result;
}

/// Matrices and offsets, with and without a clamp.
template <typename Run>
void expectAffine(const Run& run) {
  for (const bool clampsBelow : {false, true}) {
    const AffineForm form{
        {1.2F, -0.3F, 0.1F, 0.05F, 0.9F, -0.2F, -0.1F, 0.2F, 1.5F}, {-0.01F, 0.0F, 0.02F}, clampsBelow};
    const std::vector<float> pixels = pixelsOfEveryKind(20'000, 7);
    const std::vector<float> given = run(deviceTables(form), pixels);
    std::vector<float> reference = pixels;
    applyDeviceKernel(DeviceKernel::Affine, deviceTables(form), reference);
    std::string first;
    EXPECT_EQ(differingBits(reference, given, first), 0U) << first;
    for (std::size_t i = 0; i < pixels.size(); i += 4) {
      const auto pixel = std::span(pixels).subspan(i, 4);
      const auto result = std::span(given).subspan(i, 4);
      const bool isFinite = std::all_of(pixel.begin(), pixel.end(), [](float value) { return std::isfinite(value); });
      double room = 0.0;
      const Eigen::Vector3d expected = affine(form, pixel, room);
      if (!isFinite || expected.cwiseAbs().maxCoeff() > std::numeric_limits<float>::max()) {
        EXPECT_EQ(differingBits(pixel, result, first), 0U) << first;
      } else if (room < 1e30) {
        for (int k = 0; k < 3; ++k) {
          EXPECT_NEAR(result[static_cast<std::size_t>(k)], expected[k], room) << i << ", " << k;
        }
      }
      EXPECT_EQ(result[3], pixel[3]);
    }
  }
}

TEST(DeviceKernelsTest, TextOnTheProcessorHasTheBitsOfTheMap) {
  expectAffine([](const DeviceTables& tables, std::vector<float> pixels) {
    applyDeviceKernel(DeviceKernel::Affine, tables, pixels);
    return pixels;
  });
  expectTheBitsOfTheMap(20'000, [](const DeviceTables& tables, std::vector<float> pixels) {
    applyDeviceKernel(DeviceKernel::Map, tables, pixels);
    return pixels;
  });
}

TEST(DeviceKernelsTest, OpenClHasTheBitsOfTheMap) {
  std::string reason;
  const auto device = OpenClDevice::find(reason);
  if (!device) {
    GTEST_SKIP() << reason << ": the OpenCL text is not run; install pocl-opencl-icd";
  }
  std::printf("[ device ] %s\n", device->name().c_str());
  const std::string text = deviceText(DeviceDialect::OpenCl, DeviceKernel::Map);
  expectTheBitsOfTheMap(pixelCount(), [&](const DeviceTables& tables, const std::vector<float>& pixels) {
    return device->run(text, "metamerMapPixels", tables, pixels);
  });
  const std::string affine = deviceText(DeviceDialect::OpenCl, DeviceKernel::Affine);
  expectAffine([&](const DeviceTables& tables, const std::vector<float>& pixels) {
    return device->run(affine, "metamerAffinePixels", tables, pixels);
  });
}

TEST(DeviceKernelsTest, MetalTextHasTheBitsOfTheMap) {
  expectTheBitsOfTheMap(pixelCount(), runMetalMap);
  expectAffine(runMetalAffine);
}

TEST(DeviceKernelsTest, GlslIsWithinALastPlaceOfTheMap) {
  std::string reason;
  const auto device = EglDevice::find(reason);
  if (!device) {
    GTEST_SKIP() << reason << ": the GLSL text is not run; install libegl1 and libgl1-mesa-dri";
  }
  const std::string text = deviceText(DeviceDialect::Glsl, DeviceKernel::Map);
  std::vector<double> off;
  std::size_t same = 0;
  for (const DeviceCase& each : deviceCases()) {
    std::vector<float> pixels = pixelsOfEveryKind(20'000, 17);
    std::vector<float> expected(pixels.size());
    each.map.apply(pixels, expected);
    const std::vector<float> given = device->run(text, each.tables, pixels);
    for (std::size_t i = 0; i < pixels.size(); i += 4) {
      const Eigen::Map<const Eigen::Vector3f> pixel(pixels.data() + i);
      const Eigen::Map<const Eigen::Vector3f> result(given.data() + i);
      const Eigen::Map<const Eigen::Vector3f> wanted(expected.data() + i);
      const float size = pixel.cwiseAbs().maxCoeff();
      // What lies at the ends of all numbers a GLSL device may flush.
      if (pixel.allFinite() && size > 1e-30F && size < 1e30F) {
        ASSERT_TRUE(result.allFinite()) << each.name << ", pixel " << i / 4;
        off.push_back((result - wanted).cast<double>().cwiseAbs().maxCoeff() / size);
        same += result == wanted ? 1 : 0;
      }
      EXPECT_EQ(given[i + 3], pixels[i + 3]);
    }
  }
  std::sort(off.begin(), off.end());
  const double p999 = off[off.size() * 999 / 1000];
  std::printf("[ device ] %s: %.4f of pixels to the bit; off by %.2g of their size at p99.9, %.2g at most\n",
              device->name().c_str(), static_cast<double>(same) / static_cast<double>(off.size()), p999, off.back());
  EXPECT_LE(p999, 1e-5);
}

TEST(DeviceKernelsTest, HalfAPixelIsRefused) {
  std::vector<float> half(6);
  EXPECT_THROW(applyDeviceKernel(DeviceKernel::Affine, deviceTables(AffineForm{}), half), std::exception);
}

}  // namespace
}  // namespace metamer::sip
