// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/uplift.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "metamer/spectral/colorimetry.h"
#include "spectral/fixture.h"

namespace metamer::spectral {
namespace {

/// Built once: the table takes seconds.
const Uplift& upliftOf(const std::string& name) {
  static std::map<std::string, std::unique_ptr<Uplift>> built;
  std::unique_ptr<Uplift>& uplift = built[name];
  if (!uplift) {
    uplift = makeUplift(upliftMethodNamed(name), testLibrary());
  }
  return *uplift;
}

std::vector<double> spectrumOf(const Uplift& uplift, const Eigen::Vector3d& rgb) {
  std::vector<double> spectrum(uplift.wavelengthsNm().size());
  uplift.spectra({rgb.data(), 3}, spectrum);
  return spectrum;
}

double least(const std::vector<double>& values) {
  return *std::min_element(values.begin(), values.end());
}

double largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

/// XYZ of a spectrum of an uplift, by the library's own integrals.
Eigen::Vector3d xyzOf(const Uplift& uplift, const Eigen::Vector3d& rgb) {
  static const Spectrum light = testLibrary().illuminant("D65");
  static const Observer observer = testLibrary().observer("CIE 1931 2");
  return tristimulus(Spectrum("r", SpectralQuantity::Reflectance, uplift.wavelengthsNm(), spectrumOf(uplift, rgb)),
                     light, observer);
}

double differenceOf(const std::string& name, const Eigen::Vector3d& rgb) {
  const Uplift& uplift = upliftOf(name);
  const Eigen::Vector3d white = uplift.xyzFromRgb() * Eigen::Vector3d::Ones();
  return deltaE2000(lab(xyzOf(uplift, rgb), white), lab(uplift.xyzFromRgb() * rgb, white));
}

const Eigen::Vector3d kSkin(0.45, 0.27, 0.19);

TEST(Uplift, NamesAreOfMethods) {
  for (std::size_t i = 0; i < upliftMethodNames().size(); ++i) {
    EXPECT_EQ(upliftMethodNamed(upliftMethodNames()[i]), static_cast<UpliftMethod>(i));
  }
  EXPECT_EQ(errorOf([] { upliftMethodNamed("jakub"); }),
            "uplift 'jakub': must be one of: smits, mallett, jakob, jakob table, otsu, meng");
}

TEST(Uplift, ColoursComeBackUnderDaylight) {
  // Those that solve for the colour have it to rounding, the table to what its resolution leaves, the sums of Mallett
  // and Yuksel to the step from their 5 nm sums to ours. Smits' curves are fitted for equal energy: they do not have
  // it.
  const std::vector<std::pair<std::string, double>> bounds = {
      {"mallett", 0.1}, {"jakob", 1e-6}, {"jakob table", 0.1}, {"otsu", 1e-6}, {"meng", 1e-6}};
  for (const auto& [name, bound] : bounds) {
    for (const Eigen::Vector3d& rgb : {kSkin, Eigen::Vector3d(0.2, 0.3, 0.25), Eigen::Vector3d(0.18, 0.18, 0.18)}) {
      EXPECT_LE(differenceOf(name, rgb), bound) << name << " " << rgb.transpose();
    }
  }
  EXPECT_GT(differenceOf("smits", kSkin), 0.5);
}

TEST(Uplift, BlackAndWhite) {
  const Eigen::Vector3d black = Eigen::Vector3d::Zero();
  const Eigen::Vector3d white = Eigen::Vector3d::Ones();
  for (const std::string name : {"smits", "mallett", "meng"}) {
    EXPECT_EQ(largest(spectrumOf(upliftOf(name), black)), 0) << name;
    EXPECT_NEAR(least(spectrumOf(upliftOf(name), white)), 1, 1e-3) << name;
    EXPECT_NEAR(largest(spectrumOf(upliftOf(name), white)), 1, 1e-3) << name;
  }
  for (const std::string name : {"jakob", "jakob table"}) {
    // The table's ends are solved 2e-4 inside.
    EXPECT_LE(largest(spectrumOf(upliftOf(name), black)), 2.1e-4) << name;
    EXPECT_GE(least(spectrumOf(upliftOf(name), white)), 0.995) << name;
  }
  // The clusters have no black and no white surface of their own: cut at 0 and 1, they are near.
  EXPECT_LE(differenceOf("otsu", white), 1);
  EXPECT_LE(differenceOf("otsu", black), 3);
  EXPECT_GT(largest(spectrumOf(upliftOf("otsu"), black)), 0);
}

TEST(Uplift, OutsideTheGamutAndTheRange) {
  const std::vector<Eigen::Vector3d> outside = {{-0.3, 0.9, 0.1}, {2, 1.5, 0.2}, {-1, -1, -1}, {-0.2, -0.1, 1.2},
                                                {30, 20, 10},     {1e-30, 0, 0}, {0, 1, 0}};
  for (const std::string& name : upliftMethodNames()) {
    for (const Eigen::Vector3d& rgb : outside) {
      const std::vector<double> spectrum = spectrumOf(upliftOf(name), rgb);
      for (const double value : spectrum) {
        EXPECT_TRUE(std::isfinite(value)) << name << " " << rgb.transpose();
      }
      if (name == "otsu" || name == "jakob" || name == "jakob table") {
        EXPECT_LE(largest(spectrum), 1) << name << " " << rgb.transpose();
      }
      if (name != "smits" && name != "mallett") {
        EXPECT_GE(least(spectrum), 0) << name << " " << rgb.transpose();
      }
    }
  }
  // The linear ones go on as they are, and Meng's has no ceiling.
  EXPECT_LT(least(spectrumOf(upliftOf("smits"), {-0.3, 0.9, 0.1})), -0.2);
  EXPECT_LT(least(spectrumOf(upliftOf("mallett"), {-0.3, 0.9, 0.1})), -0.2);
  EXPECT_GT(largest(spectrumOf(upliftOf("meng"), {30, 20, 10})), 10);
  // What light can be but Rec.709 cannot show, Meng's has; what light cannot be keeps its luminance.
  EXPECT_LE(differenceOf("meng", {-0.05, 0.6, 0.1}), 1e-6);
  const Eigen::Vector3d none(-0.5, 0.9, -0.5);
  const Uplift& meng = upliftOf("meng");
  EXPECT_NEAR(xyzOf(meng, none).y(), (meng.xyzFromRgb() * none).y(), 1e-9);
  EXPECT_GT(differenceOf("meng", none), 1);
}

TEST(Uplift, NotANumberStaysWhereItIs) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  const std::vector<double> rgb = {0.45, 0.27, 0.19, 0.2, nan, 0.1, 0.45, 0.27, 0.19, infinite, 0, 0, 0.45, 0.27, 0.19};
  for (const std::string& name : upliftMethodNames()) {
    const Uplift& uplift = upliftOf(name);
    const std::size_t size = uplift.wavelengthsNm().size();
    std::vector<double> spectra(5 * size);
    uplift.spectra(rgb, spectra);
    const std::vector<double> alone = spectrumOf(uplift, kSkin);
    for (std::size_t i = 0; i < spectra.size(); ++i) {
      if (i / size % 2 == 1) {
        EXPECT_TRUE(std::isnan(spectra[i])) << name;
      } else {
        EXPECT_EQ(spectra[i], alone[i % size]) << name;
      }
    }
  }
}

TEST(Uplift, TableTakesWhatIsNoColour) {
  const JakobTable table(testLibrary(), 8);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinite = std::numeric_limits<float>::infinity();
  EXPECT_EQ(table.coefficients({nan, 0.5F, 0.2F}), table.coefficients({0, 0.5F, 0.2F}));
  EXPECT_EQ(table.coefficients({infinite, -1, 0.5F}), table.coefficients({1, 0, 0.5F}));
  EXPECT_EQ(errorOf([] { JakobTable(testLibrary(), 2); }), "resolution '2': must be from 4 to 128");
}

TEST(Uplift, RefusesOtherSizes) {
  const Uplift& uplift = upliftOf("smits");
  std::vector<double> spectrum(10);
  const std::vector<double> four(4);
  EXPECT_NE(errorOf([&] { uplift.spectra(four, spectrum); }), "no InputError");
  spectrum.resize(9);
  EXPECT_NE(errorOf([&] { uplift.spectra({four.data(), 3}, spectrum); }), "no InputError");
  EXPECT_EQ(errorOf([] { makeUplift(UpliftMethod::Meng, testLibrary(), UpliftWeights::Ones(3, 3)); }),
            "weights '3': must be one row a wavelength, 81");
  EXPECT_EQ(errorOf([] { makeUplift(UpliftMethod::Meng, testLibrary(), UpliftWeights::Zero(81, 3)); }),
            "weights: must be finite, and see light in X, Y and Z");
}

}  // namespace
}  // namespace metamer::spectral
