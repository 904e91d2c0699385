// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/spectral_integral.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "metamer/spectral/colorimetry.h"
#include "spectral/fixture.h"

namespace metamer::spectral {
namespace {

constexpr SpectralQuantity kPower = SpectralQuantity::SpectralPowerDistribution;

/// The integral of a light times a curve, piece by piece between all samples' wavelengths by Simpson's rule, which is
/// exact for a product of lines: another way than the library's.
double exactIntegral(const Spectrum& light, const Spectrum& curve) {
  std::vector<double> knots = light.wavelengthsNm();
  knots.insert(knots.end(), curve.wavelengthsNm().begin(), curve.wavelengthsNm().end());
  std::sort(knots.begin(), knots.end());
  long double sum = 0;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const double start = std::max(knots[i], 380.0);
    const double width = std::min(knots[i + 1], 780.0) - start;
    if (width > 0) {
      const auto at = [&](double t) {
        return static_cast<long double>(light.at(start + t * width)) * curve.at(start + t * width);
      };
      // Ends a little inside: a light is zero beyond its first and last sample.
      sum += width * (at(1e-12) + 4 * at(0.5) + at(1 - 1e-12)) / 6;
    }
  }
  return static_cast<double>(sum);
}

Eigen::Vector3d exactResponse(const Spectrum& light, const Observer& observer) {
  return {exactIntegral(light, observer.curves[0]), exactIntegral(light, observer.curves[1]),
          exactIntegral(light, observer.curves[2])};
}

Spectrum triangle(double centre, double fwhm) {
  return {"line", kPower, {380, centre - fwhm, centre, centre + fwhm, 780}, {0, 0, 1 / fwhm, 0, 0}};
}

/// A bell with 40 samples a half width, as a fine spectrometer would give it.
Spectrum bell(double centre, double fwhm) {
  std::vector<double> nm{380};
  std::vector<double> values{0};
  for (int i = -100; i <= 100; ++i) {
    nm.push_back(centre + fwhm * i / 40);
    values.push_back(std::exp(-4 * std::log(2.0) * i * i / 1600) / fwhm);
  }
  nm.push_back(780);
  values.push_back(0);
  return {"bell", kPower, nm, values};
}

TEST(SpectralIntegralTest, LinesOfAnyWidthAtAnyPlace) {
  const Observer observer = testLibrary().observer("CIE 1931 2");
  // Whites are compared as a user sees them: three lines of one width, against their exact integrals.
  const Eigen::Vector3d d65 = response(testLibrary().illuminant("D65"), observer);
  double worst = 0;
  double worstDeltaE = 0;
  for (const double fwhm : {0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0}) {
    for (int phase = 0; phase < 12; ++phase) {
      for (const auto& line : {triangle, bell}) {
        for (const double centre : {450.0, 532.0, 555.0, 589.0, 640.0}) {
          const Spectrum light = line(centre + phase / 12.0, fwhm);
          const Eigen::Vector3d exact = exactResponse(light, observer);
          const Eigen::Vector3d found = response(light, observer);
          worst = std::max(worst, (found - exact).norm() / exact.norm());
          const Eigen::Vector3d white = d65 / d65.y() * exact.y();
          worstDeltaE = std::max(worstDeltaE, deltaE2000(lab(found, white), lab(exact, white)));
        }
      }
    }
  }
  EXPECT_LT(worst, 1e-9);  // the ends of the reference's pieces; the project asks for 1e-6
  EXPECT_LT(worstDeltaE, 0.05);
  RecordProperty("worst", std::to_string(worst));
}

TEST(SpectralIntegralTest, FiltersAndObserversWithSamplesOfTheirOwn) {
  const Spectrum light = triangle(532.3, 0.2);
  const Spectrum edge("edge", SpectralQuantity::Transmittance, {500, 532.2, 532.35, 600}, {0, 0, 1, 1});
  const Spectrum ramp("ramp", SpectralQuantity::Sensitivity, {500.25, 532.45, 590.5}, {0, 1, 0});
  const Observer observer{"ramps", Observer::Response::Camera, {ramp, ramp, ramp}, {}};
  const SeenLight seen = seenLight(light, {{edge, 1.0}}, observer);
  // A sum of 3 million places: its own error is of the order of their square.
  long double expected = 0;
  constexpr int kPlaces = 3'000'000;
  for (int i = 0; i < kPlaces; ++i) {
    const double nm = 532.0 + (i + 0.5) / kPlaces;
    expected += static_cast<long double>(light.at(nm) * edge.at(nm) * ramp.at(nm)) / kPlaces;
  }
  EXPECT_NEAR((seen.curves.transpose() * seen.light).x(), static_cast<double>(expected), 1e-9);
}

TEST(SpectralIntegralTest, PrintedTablesAndFormulasAreSummed) {
  for (const char* const name : {"D65", "FL11", "HP1", "LED-RGB1", "LPS", "3200 K", "daylight 5600 K"}) {
    EXPECT_TRUE(isSummed(testLibrary().illuminant(name))) << name;
  }
  for (const char* const name : {"CIE 1931 2", "Nikon D5100"}) {
    for (const Spectrum& curve : testLibrary().observer(name).curves) {
      EXPECT_TRUE(isSummed(curve)) << name;
    }
  }
  EXPECT_FALSE(isSummed(triangle(550, 1)));
  EXPECT_FALSE(isSummed({"short", kPower, {545, 550, 555}, {0, 1, 0}}));
}

TEST(SpectralIntegralTest, EnergyOfALineIsKept) {
  for (const double fwhm : {0.05, 0.6, 3.0}) {
    // Rounding of a few hundred terms.
    EXPECT_NEAR(lightOnDomain(triangle(588.97, fwhm)).sum(), 1, 1e-12);
  }
}

}  // namespace
}  // namespace metamer::spectral
