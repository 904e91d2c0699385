// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/lut_writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "cube/shaper_curve.h"
#include "metamer/ocio/log_cube.h"
#include "metamer/ocio/pixel_processor.h"
#include "metamer/ocio/shaper.h"
#include "metamer/spectral/pending_file.h"
#include "sip/sip_fixture.h"
#include "spectral/temporary_folder.h"

namespace metamer::ocio {
namespace {

constexpr int kSize = 17;

std::vector<float> probes(float low, float high) {
  std::mt19937 random(7);
  std::vector<float> rgba;
  for (int k = 0; k < 2000; ++k) {
    for (int channel = 0; channel < 3; ++channel) {
      rgba.push_back(low + (high - low) * static_cast<float>(sip::unitRandom(random)));
    }
    rgba.push_back(0.5F);
  }
  return rgba;
}

/// What the format's digits are worth. Our own writers have seven after the point, OCIO's baker six, 12-bit tables a
/// half of 1 / 4095; curves of 4096 entries are straight between. A lookup loses another digit.
double precision(const std::string& name) {
  if (name == "flame" || name == "lustre") {
    return 0.51 / 4095.0;
  }
  return name == "spi1d" ? 1e-3 : name.find("cube") != std::string::npos || name == "spi3d" ? 1e-6 : 2e-6;
}

bool hasIntegers(const std::string& name) {
  return name == "flame" || name == "lustre";
}

bool hasComments(const std::string& name) {
  return name != "houdini" && name != "spi3d" && name != "spi1d";
}

class LutWriterTest : public testing::TestWithParam<std::size_t> {
 protected:
  const LutFormat& format() const { return lutFormats()[GetParam()]; }
  /// A group that the format can hold, exactly.
  OCIO::GroupTransformRcPtr group() const {
    auto result = OCIO::GroupTransform::Create();
    if (format().content == LutFormat::Content::Curves) {
      auto curve = OCIO::ExponentTransform::Create();
      curve->setValue({0.8, 1.0, 1.3, 1.0});
      result->appendTransform(curve);
      return result;
    }
    const Signal signal = {shaperTransform(spectral::LogEncoding::AcesCct, OCIO::TRANSFORM_DIR_INVERSE),
                           shaperTransform(spectral::LogEncoding::AcesCct, OCIO::TRANSFORM_DIR_FORWARD)};
    const auto spec = sip::specOf("D65", "A");
    result->appendTransform(
        logCube(sip::SpectralTransform(spec), signal,
                {.size = kSize, .fitted = hasIntegers(format().name), .belowZero = !hasIntegers(format().name)}));
    return result;
  }
};

TEST_P(LutWriterTest, ReadsBackAsWhatWasWritten) {
  const TemporaryFolder folder;
  const auto file = folder / ("lut" + format().extension);
  const LutDescription description{"name with \"quotes\" & <tags>", "id-1", {"first line", "second <line> & more"}};
  spectral::PendingFile pending(file);
  pending.write(lutText(format(), group(), kSize, description));
  pending.commit();
  // The integers of .3dl end at 0 and 1, where a fitted table stays but near white; spi1d is asked where its curve is.
  const bool isWithin = hasIntegers(format().name) || format().content == LutFormat::Content::Curves;
  std::vector<float> expected = isWithin ? probes(0.0F, 0.8F) : probes(-0.2F, 1.2F);
  std::vector<float> found = expected;
  PixelProcessor(group()).apply(expected);
  PixelProcessor::fromFile(file).apply(found);
  for (std::size_t k = 0; k < found.size(); ++k) {
    const float wanted = hasIntegers(format().name) ? std::clamp(expected[k], 0.0F, 1.0F) : expected[k];
    ASSERT_NEAR(found[k], wanted, precision(format().name) * std::max(1.0F, std::abs(wanted))) << k;
  }
}

TEST_P(LutWriterTest, SaysWhatItIsAndIsTheSameEveryTime) {
  const LutDescription description{"a name", "id-1", {"first line", "second line"}};
  const std::string text = lutText(format(), group(), kSize, description);
  for (const char* part : {"a name", "first line", "second line"}) {
    EXPECT_EQ(hasComments(format().name), text.find(part) != std::string::npos) << part;
  }
  EXPECT_EQ(text, lutText(format(), group(), kSize, description));
}

TEST_P(LutWriterTest, IsFoundByNameAndExtension) {
  const std::string file = "out" + format().extension;
  EXPECT_EQ(&lutFormat(file, format().name), &format());
  EXPECT_EQ(lutFormat(file, "").extension, format().extension);
}

INSTANTIATE_TEST_SUITE_P(All, LutWriterTest, testing::Range(std::size_t{0}, lutFormats().size()),
                         [](const auto& instance) { return "Format" + std::to_string(instance.index); });

TEST(CubeTest, FlavoursKeepApart) {
  auto identity = OCIO::GroupTransform::Create();
  const LutDescription description{"n", "i", {}};
  const std::string iridas = lutText(lutFormat("a.cube", "iridas_cube"), identity, 3, description);
  const std::string resolve = lutText(lutFormat("a.cube", "resolve_cube"), identity, 3, description);
  EXPECT_NE(iridas.find("DOMAIN_MIN 0 0 0\nDOMAIN_MAX 1 1 1\n"), std::string::npos);
  EXPECT_EQ(iridas.find("INPUT_RANGE"), std::string::npos);
  EXPECT_NE(resolve.find("LUT_3D_INPUT_RANGE 0.0 1.0\n"), std::string::npos);
  EXPECT_EQ(resolve.find("DOMAIN"), std::string::npos);
  // Red runs fastest, in plain decimals.
  EXPECT_NE(resolve.find("0.0000000 0.0000000 0.0000000\n0.5000000 0.0000000 0.0000000\n1.0000000"), std::string::npos);
  EXPECT_EQ(lutFormat("A.CUBE", "").name, "iridas_cube");
}

// A group that starts with a 1-D shaper keeps it where the format has one; what only looks like one is left in the
// table.
TEST(CubeTest, ShaperCurvesAreKept) {
  const Signal signal = {shaperTransform(spectral::LogEncoding::AcesCct, OCIO::TRANSFORM_DIR_INVERSE),
                         shaperTransform(spectral::LogEncoding::AcesCct, OCIO::TRANSFORM_DIR_FORWARD)};
  const OCIO::Lut1DTransformRcPtr curve = shaperCurve(signal, kSize, -7.0, 1000);
  auto group = OCIO::GroupTransform::Create();
  group->appendTransform(curve);
  group->appendTransform(
      logCube(sip::SpectralTransform(sip::specOf("D65", "HP1")), signal, {.size = kSize, .shaperCurve = curve}));
  const LutDescription description{"n", "i", {}};
  const TemporaryFolder folder;
  const std::vector<float> in = probes(-0.2F, 1.2F);
  std::vector<float> expected = in;
  PixelProcessor(group).apply(expected);
  for (const LutFormat& format : lutFormats()) {
    if (format.holdsShaperCurve) {
      const auto file = folder / ("a" + format.extension);
      spectral::writeWholeFile(file, lutText(format, group, kSize, description));
      std::vector<float> found = in;
      PixelProcessor::fromFile(file).apply(found);
      float largest = 0.0F;
      for (std::size_t k = 0; k < found.size(); ++k) {
        largest = std::max(largest, std::abs(found[k] - expected[k]) / std::max(1.0F, std::abs(expected[k])));
      }
      // The steepest cell falls by ten signals, of which colours meet half: with 16 cells so many times a digit counts.
      EXPECT_LE(largest, 80.0 * precision(format.name)) << format.name;
      std::printf("%s: %.1e\n", format.name.c_str(), static_cast<double>(largest));
    }
  }
  EXPECT_NE(lutText(lutFormat("a.cube", "resolve_cube"), group, kSize, description)
                .find("LUT_1D_SIZE 1000\nLUT_1D_INPUT_RANGE 0.0 1.0\nLUT_3D_SIZE 17\n"),
            std::string::npos);

  // Without a place for it, it is part of what is tabulated.
  auto whole = OCIO::GroupTransform::Create();
  whole->appendTransform(group);
  for (const LutFormat& format : lutFormats()) {
    if (format.content == LutFormat::Content::Cube && !format.holdsShaperCurve) {
      EXPECT_EQ(lutText(format, group, kSize, description), lutText(format, whole, kSize, description)) << format.name;
    }
  }

  curve->setValue(999, 0.9F, 0.9F, 0.9F);
  EXPECT_EQ(lutText(lutFormat("a.cube", "resolve_cube"), group, kSize, description).find("LUT_1D"), std::string::npos);
}

TEST(LutFormatTest, UnknownFormatsListTheKnown) {
  for (const auto& [file, format] : {std::pair{"a.png", ""}, {"a", ""}, {"a.cube", "banana"}}) {
    const std::string error = spectral::errorOf([file = file, format = format] { lutFormat(file, format); });
    EXPECT_NE(error.find("resolve_cube (.cube)"), std::string::npos) << error;
  }
  const std::string error = spectral::errorOf([] { lutFormat("a.clf", "resolve_cube"); });
  EXPECT_NE(error.find("name the file *.cube"), std::string::npos) << error;
}

TEST(PixelProcessorTest, RefusesFilesThatAreNoLut) {
  const TemporaryFolder folder;
  EXPECT_NE(spectral::errorOf([&] { PixelProcessor::fromFile(folder / "missing.cube"); }).find("no such file"),
            std::string::npos);
  std::ofstream(folder / "bad.cube") << "LUT_3D_SIZE 1000000\n0 0 0\n";
  EXPECT_NE(spectral::errorOf([&] { PixelProcessor::fromFile(folder / "bad.cube"); }).find("cannot be read"),
            std::string::npos);
}

}  // namespace
}  // namespace metamer::ocio
