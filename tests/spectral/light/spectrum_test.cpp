// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/spectrum.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "spectral/fixture.h"

namespace metamer::spectral {
namespace {

using Quantity = SpectralQuantity;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(SpectrumTest, LinearBetweenSamplesAndExactAtThem) {
  const Spectrum s("s", Quantity::Reflectance, {400, 410, 430}, {0.1, 0.3, 0.7});
  EXPECT_DOUBLE_EQ(s.at(405), 0.2);
  EXPECT_DOUBLE_EQ(s.at(425), 0.6);
  EXPECT_EQ(s.at(400), 0.1);
  EXPECT_EQ(s.at(410), 0.3);
  EXPECT_EQ(s.at(430), 0.7);
}

TEST(SpectrumTest, OutsideItsRangeAsTheQuantitySays) {
  for (const Quantity quantity : {Quantity::Reflectance, Quantity::Transmittance}) {
    const Spectrum s("s", quantity, {400, 700}, {0.25, 0.75});
    EXPECT_EQ(s.at(380), 0.25);
    EXPECT_EQ(s.at(780), 0.75);
  }
  for (const Quantity quantity : {Quantity::SpectralPowerDistribution, Quantity::Sensitivity}) {
    const Spectrum s("s", quantity, {400, 700}, {0.25, 0.75});
    EXPECT_EQ(s.at(399.999), 0);
    EXPECT_EQ(s.at(700.001), 0);
    EXPECT_EQ(s.at(700), 0.75);
  }
}

TEST(SpectrumTest, OnDomain) {
  const DomainSamples samples = Spectrum("s", Quantity::SpectralPowerDistribution, {390, 770}, {0, 380}).onDomain();
  EXPECT_EQ(samples[0], 0);
  EXPECT_DOUBLE_EQ(samples[11], 1);
  EXPECT_EQ(samples[390], 380);
  EXPECT_EQ(samples[391], 0);
}

TEST(SpectrumTest, SurfacesOnTheDomainAreTheirValuesAtEveryNanometre) {
  const std::vector<std::vector<double>> wavelengths = {
      {300, 379.5, 380, 380.25, 381, 600, 600.5, 900}, {380, 780}, {390.5, 391, 770}, {300, 310}, {790, 800}};
  for (const auto& nm : wavelengths) {
    std::vector<double> values;
    for (std::size_t i = 0; i < nm.size(); ++i) {
      values.push_back(0.1 + 0.3 * static_cast<double>(i % 3));
    }
    for (const Quantity quantity : {Quantity::Reflectance, Quantity::Sensitivity}) {
      const Spectrum spectrum("s", quantity, nm, values);
      const DomainSamples samples = spectrum.onDomain();
      for (int i = 0; i < kDomainSize; ++i) {
        ASSERT_EQ(samples[i], spectrum.at(kDomainStartNm + i)) << nm.front() << " nm on, " << i;
      }
    }
  }
}

TEST(SpectrumTest, Shape) {
  const SpectralShape even = Spectrum("s", Quantity::Reflectance, {400, 410, 420}, {0, 0, 0}).shape();
  EXPECT_EQ(even.startNm, 400);
  EXPECT_EQ(even.endNm, 420);
  EXPECT_EQ(even.intervalNm, 10);
  EXPECT_EQ(Spectrum("s", Quantity::Reflectance, {400, 410, 430}, {0, 0, 0}).shape().intervalNm, 0);
  const Spectrum rounded("s", Quantity::Reflectance, {400, 403.333, 406.667, 410}, {0, 0, 0, 0});
  EXPECT_NEAR(rounded.shape().intervalNm, 10.0 / 3, 1e-12);
}

TEST(SpectrumTest, RefusesWhatItsConditionsExclude) {
  struct Case {
    std::vector<double> wavelengths;
    std::vector<double> values;
    std::string error;
  };
  const std::vector<Case> cases{
      {{400}, {1}, "lamp: samples '1': a spectrum needs at least two"},
      {{400, 410}, {1}, "lamp: values '1': must be as many as wavelengths, 2"},
      {{410, 400}, {1, 1}, "lamp: wavelength '400': must be above the one before it, 410 nm"},
      {{400, 400}, {1, 1}, "lamp: wavelength '400': must be above the one before it, 400 nm"},
      {{0, 400}, {1, 1}, "lamp: wavelength '0': must be a finite number of nm above 0"},
      {{400, kNan}, {1, 1}, "lamp: wavelength 'nan': must be a finite number of nm above 0"},
      {{400, 410}, {1, kNan}, "lamp: value at 410 nm 'nan': must be a finite number"},
      {{400, 410},
       {-0.5, 1},
       "lamp: value at 400 nm '-0.5': must not be negative; set measurement noise below zero to 0"},
  };
  for (const Case& c : cases) {
    EXPECT_EQ(errorOf([&] { Spectrum("lamp", Quantity::SpectralPowerDistribution, c.wavelengths, c.values); }),
              c.error);
  }
  EXPECT_NO_THROW(Spectrum("cmf", Quantity::Sensitivity, {400, 410}, {-0.5, 1}));
}

}  // namespace
}  // namespace metamer::spectral
