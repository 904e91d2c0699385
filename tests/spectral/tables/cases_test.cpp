// SPDX-License-Identifier: Apache-2.0
// Files that users' meters and programs wrote, the smallest of their kinds.
#include <gtest/gtest.h>

#include "metamer/spectral/colorimetry.h"
#include "metamer/spectral/data_library.h"
#include "metamer/spectral/optical_constants.h"
#include "metamer/spectral/spectral_files.h"
#include "spectral/fixture.h"

namespace metamer::spectral {
namespace {

constexpr SpectralQuantity kPower = SpectralQuantity::SpectralPowerDistribution;

std::string file(const std::string& name) {
  return std::string(METAMER_CASES_FOLDER) + "/" + name;
}

Eigen::Vector2d white(const std::string& name) {
  const std::vector<Spectrum> spectra = readSpectralFile(file(name), kPower);
  EXPECT_EQ(spectra.size(), 1U) << name;
  return chromaticity(response(spectra.front(), testLibrary().observer("CIE 1931 2")));
}

TEST(SpectraCases, EveryExportOfOneLamp) {
  // All hold the blackbody of 3200 K, to three to nine digits; 380 to 730 nm in lamp.sp. By colour-science:
  // sd_blackbody(3200), summed at 1 nm.
  const Eigen::Vector2d expected(0.42336, 0.39896);
  for (const char* const name : {"sekonic.csv", "excel_sep.csv", "units_row.csv", "summary_tail.csv", "nm_suffix.csv",
                                 "transposed.csv", "lamp.sp"}) {
    EXPECT_LT((white(name) - expected).cwiseAbs().maxCoeff(), 2e-4) << name;
  }
  EXPECT_EQ(readSpectralFile(file("excel_sep.csv"), kPower)[0].name(), "Leistung");
  EXPECT_EQ(readSpectralFile(file("transposed.csv"), kPower)[0].name(), "lamp");
  EXPECT_EQ(readSpectralFile(file("units_row.csv"), kPower)[0].name(), "Power");
  EXPECT_EQ(readSpectralFile(file("sekonic.csv"), kPower)[0].name(), "sekonic");
}

TEST(SpectraCases, WhatIsNotUsedDoesNotMatter) {
  for (const char* const name : {"nan_uv.csv", "neg_uv.csv"}) {
    const Spectrum lamp = readSpectralFile(file(name), kPower)[0];
    EXPECT_EQ(lamp.at(380), 1) << name;
    EXPECT_EQ(lamp.at(780), 2) << name;
    EXPECT_TRUE(lamp.notes().empty()) << name;
  }
  const std::vector<Spectrum> eye = readSpectralFile(file("blank_tail.csv"), SpectralQuantity::Sensitivity);
  ASSERT_EQ(eye.size(), 3U);
  EXPECT_EQ(eye[2].wavelengthsNm().back(), 615);
  EXPECT_EQ(eye[2].at(700), 0);
  // An empty cell is no dark lamp, and no clear gel.
  EXPECT_EQ(errorOf([] { readSpectralFile(file("blank_tail.csv"), SpectralQuantity::Reflectance); }),
            file("blank_tail.csv") + ":48: value: is empty; give a number or remove the row");
}

TEST(SpectraCases, NoiseBelowZeroIsCutAndCounted) {
  const Spectrum lamp = readSpectralFile(file("ocean_bare.txt"), kPower)[0];
  ASSERT_EQ(lamp.notes().size(), 1U);
  EXPECT_EQ(lamp.notes()[0], "7 values below zero set to 0, the lowest 2.84 % of the peak below it, at 379.69 nm");
  EXPECT_EQ(lamp.at(379.69), 0);
}

TEST(SpectraCases, ACutFloorGetsANote) {
  const Spectrum lamp = readSpectralFile(std::string(METAMER_LAMPS_FOLDER) + "/cfl_with_zeros.csv", kPower)[0];
  ASSERT_EQ(lamp.notes().size(), 1U);
  EXPECT_EQ(lamp.notes()[0].rfind("151 of its 316 values from 399 to 714 nm are exactly 0", 0), 0U) << lamp.notes()[0];
}

TEST(SpectraCases, ALampOfSeveralIsNamed) {
  const std::string both = file("two_lamps.csv");
  EXPECT_EQ(testLibrary().illuminant(both + ":cool").values(), (std::vector<double>{2, 4}));
  EXPECT_EQ(testLibrary().illuminant(both + ":Warm").values(), (std::vector<double>{1, 3}));
  EXPECT_EQ(testLibrary().illuminant(both + ":2").values(), (std::vector<double>{2, 4}));
  EXPECT_EQ(errorOf([&] { testLibrary().illuminant(both); }),
            both + ": columns '2': are several curves; name one as FILE:COLUMN, of: warm, cool");
  EXPECT_EQ(errorOf([&] { testLibrary().illuminant(both + ":hot"); }),
            both + ": column 'hot': is not there; give a name or a number from 1 of: warm, cool");
  EXPECT_EQ(errorOf([&] { testLibrary().illuminant(both + ":3"); }),
            both + ": column '3': is not there; give a name or a number from 1 of: warm, cool");
  EXPECT_EQ(testLibrary().provenance("illuminants", both + ":cool").file, both);
}

TEST(SpectraCases, LinesCountAtTheirPlaces) {
  // Each line's area times the curves at its centre, which are straight lines there to 0.3 nm.
  const Observer observer = testLibrary().observer("CIE 1931 2");
  Eigen::Vector3d expected = Eigen::Vector3d::Zero();
  const auto line = [&](double nm, double area) {
    for (int k = 0; k < 3; ++k) {
      expected[k] += area * observer.curves[static_cast<std::size_t>(k)].at(nm);
    }
  };
  line(465.3, 240);
  line(532.5, 300);
  line(638.5, 270);
  EXPECT_LT((white("line3.csv") - chromaticity(expected)).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(SpectraCases, RefractiveIndexIsReadInMicrometres) {
  const Spectrum n = readOpticalConstant(file("ri_um.csv"), OpticalConstant::Refraction);
  EXPECT_NEAR(n.at(380), 1.533745, 1e-12);
  EXPECT_NEAR(n.at(600), 1.516295, 1e-12);
  EXPECT_NE(errorOf([] { readOpticalConstant(file("ri_um.csv"), OpticalConstant::Extinction); }), "no InputError");
}

}  // namespace
}  // namespace metamer::spectral
