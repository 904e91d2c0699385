// SPDX-License-Identifier: Apache-2.0
#include "cube/shaper_curve.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "metamer/ocio/pixel_processor.h"
#include "metamer/ocio/shaper.h"
#include "metamer/spectral/log_encoding.h"

namespace metamer::ocio {
namespace {

Signal signalOf(spectral::LogEncoding encoding) {
  return {shaperTransform(encoding, OCIO::TRANSFORM_DIR_INVERSE),
          shaperTransform(encoding, OCIO::TRANSFORM_DIR_FORWARD)};
}

/// Where grey light lies on a table's axes, in nodes.
double nodesAt(const PixelProcessor& axes, int size, double light) {
  const auto grey = static_cast<float>(light);
  std::array<float, 4> pixel = {grey, grey, grey, 1.0F};
  axes.apply(pixel);
  return static_cast<double>(pixel[1]) * (size - 1);
}

class ShaperCurveTest : public testing::TestWithParam<spectral::LogEncoding> {};

TEST_P(ShaperCurveTest, RisesFromZeroToOne) {
  for (const int entries : {2, 50, kShaperCurveEntries, 65536}) {
    const auto curve = shaperCurve(signalOf(GetParam()), 33, -7.0, entries);
    ASSERT_EQ(curve->getLength(), static_cast<unsigned long>(entries));
    float last = -1.0F;
    for (unsigned long k = 0; k < curve->getLength(); ++k) {
      std::array<float, 3> entry{};
      curve->getValue(k, entry[0], entry[1], entry[2]);
      ASSERT_GT(entry[0], last) << entries << " " << k;
      ASSERT_EQ(entry[0], entry[1]);
      ASSERT_EQ(entry[0], entry[2]);
      ASSERT_TRUE(k != 0 || entry[0] == 0.0F);
      last = entry[0];
    }
    EXPECT_EQ(last, 1.0F);
  }
}

// As many nodes for a stop at the dark end of the range as in its middle, but for the curve's way to black.
TEST_P(ShaperCurveTest, SpreadsNodesEvenlyOverStops) {
  constexpr int kSize = 33;
  for (const double lowest : {-7.0, -3.0}) {
    const Signal signal = signalOf(GetParam());
    const PixelProcessor axes(
        behindShaperCurve(signal, shaperCurve(signal, kSize, lowest, kShaperCurveEntries)).fromEngine);
    const double dark = 0.18 * std::exp2(lowest);
    const double aStop = nodesAt(axes, kSize, 0.36) - nodesAt(axes, kSize, 0.18);
    EXPECT_GT(aStop, 1.0);
    EXPECT_NEAR(nodesAt(axes, kSize, 2.0 * dark) - nodesAt(axes, kSize, dark), aStop, 0.06 * aStop);
  }
}

TEST_P(ShaperCurveTest, PutsBlackOnANode) {
  const Signal signal = signalOf(GetParam());
  const PixelProcessor axes(behindShaperCurve(signal, shaperCurve(signal, 33, -7.0, 65536)).fromEngine);
  const double black = nodesAt(axes, 33, 0.0);
  EXPECT_NEAR(black, std::round(black), 0.05);
}

TEST_P(ShaperCurveTest, ComesBack) {
  const Signal signal = signalOf(GetParam());
  const Signal axes = behindShaperCurve(signal, shaperCurve(signal, 33, -7.0, kShaperCurveEntries));
  const PixelProcessor there(axes.fromEngine);
  const PixelProcessor back(axes.toEngine);
  for (const float light : {0.0005F, 0.002F, 0.03F, 0.18F, 1.0F, 5.0F}) {
    std::array<float, 4> pixel = {light, light, light, 1.0F};
    there.apply(pixel);
    back.apply(pixel);
    EXPECT_NEAR(pixel[1], light, 2e-4F * light);
  }
}

INSTANTIATE_TEST_SUITE_P(All, ShaperCurveTest, testing::ValuesIn(spectral::allLogEncodings()),
                         [](const auto& instance) {
                           std::string name = spectral::nameOf(instance.param);
                           std::erase_if(name, [](unsigned char c) { return std::isalnum(c) == 0; });
                           return name;
                         });

TEST(LeadingShaperCurveTest, IsACurveFromZeroToOneBeforeSomething) {
  const auto group = OCIO::GroupTransform::Create();
  EXPECT_EQ(leadingShaperCurve(group), nullptr);
  const auto curve = OCIO::Lut1DTransform::Create(3, false);
  group->appendTransform(curve);
  EXPECT_EQ(leadingShaperCurve(group), nullptr) << "nothing follows";
  group->appendTransform(OCIO::MatrixTransform::Create());
  EXPECT_NE(leadingShaperCurve(group), nullptr);
  const auto isOne = [&](float first, float second, float third) {
    const auto other = OCIO::Lut1DTransform::Create(3, false);
    other->setValue(0, first, first, first);
    other->setValue(1, second, second, second);
    other->setValue(2, third, third, third);
    const auto changed = OCIO::GroupTransform::Create();
    changed->appendTransform(other);
    changed->appendTransform(OCIO::MatrixTransform::Create());
    return leadingShaperCurve(changed) != nullptr;
  };
  EXPECT_TRUE(isOne(0.0F, 0.7F, 1.0F));
  EXPECT_FALSE(isOne(0.1F, 0.7F, 1.0F));
  EXPECT_FALSE(isOne(0.0F, 1.7F, 1.0F));
  EXPECT_FALSE(isOne(0.0F, 0.7F, 0.9F));
  const auto reversed = OCIO::GroupTransform::Create();
  reversed->appendTransform(curve->createEditableCopy());
  reversed->getTransform(0)->setDirection(OCIO::TRANSFORM_DIR_INVERSE);
  reversed->appendTransform(OCIO::MatrixTransform::Create());
  EXPECT_EQ(leadingShaperCurve(reversed), nullptr);
}

}  // namespace
}  // namespace metamer::ocio
