// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/fluorescence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <vector>

#include "metamer/spectral/colorimetry.h"
#include "metamer/spectral/formatted.h"
#include "metamer/spectral/spectral_picture.h"
#include "spectral/fluorescence/made_matrix.h"
#include "spectral/refusals.h"

namespace metamer::spectral {
namespace {

const Reradiation& matrixOf(const Fluorescence& surface) {
  return std::get<Reradiation>(surface);
}

std::string csvOf(const Reradiation& matrix) {
  std::string text = "emission_nm/excitation_nm";
  for (const double nm : matrix.excitationNm()) {
    text += formatted(",%g", nm);
  }
  for (Eigen::Index o = 0; o < matrix.factors().rows(); ++o) {
    text += formatted("\n%g", matrix.emissionNm()[static_cast<std::size_t>(o)]);
    for (Eigen::Index i = 0; i < matrix.factors().cols(); ++i) {
      text += formatted(",%.17g", matrix.factors()(o, i));
    }
  }
  return text + "\n";
}

TEST(FluorescenceTest, FitFindsAMadeDyeAgain) {
  const MadeDye dye;
  const FluorescenceFit fit = fitFluorescence(madeMatrix({dye}));
  EXPECT_LT(fit.residual, 1e-5);
  // What the dye takes is all that the ground, 0.85, does not reflect, and 0.15 more: the yield found is the least.
  EXPECT_LT(fit.surface.quantumYield, dye.yield);
  EXPECT_GT(fit.surface.quantumYield, 0.6 * dye.yield);
  const double scale = fit.surface.quantumYield / dye.yield;
  for (const double nm : {350.0, 420.0, 460.0}) {
    EXPECT_NEAR(fit.surface.excitation.at(nm) * scale, dye.taken(nm), 1e-4) << nm;
  }
  // By 1 nm both are one surface, but for what interpolation does beside the diagonal.
  const auto light = onExcitation(testLibrary().illuminant("D65"));
  const ExcitationSamples matrix = samplesOf(madeMatrix({dye})).givenBack(light);
  const ExcitationSamples compact = samplesOf(fit.surface).givenBack(light);
  EXPECT_LT((matrix - compact).cwiseAbs().maxCoeff() / matrix.maxCoeff(), 0.02);
}

TEST(FluorescenceTest, FitSaysWhatRankOneLeaves) {
  const FluorescenceFit two = fitFluorescence(madeMatrix({MadeDye{360, 430, 0.9}, MadeDye{500, 600, 0.7}}));
  EXPECT_GT(two.residual, 0.2);
  EXPECT_LT(two.residual, 1.0);
  EXPECT_LE(samplesOf(two.surface).mostPhotons(), 1.0 + 1e-9);
  std::printf("two dyes in one: rms left %.3f\n", two.residual);
  const Reradiation grey("grey", madeBands(), madeBands(), 0.4 * Eigen::MatrixXd::Identity(49, 49));
  const FluorescenceFit none = fitFluorescence(grey);
  EXPECT_EQ(none.residual, 0.0);
  EXPECT_EQ(none.surface.quantumYield, 0.0);
  EXPECT_EQ(samplesOf(none.surface).perNm.maxCoeff(), 0.0);
}

/// A dye whose emission follows its excitation a little, as dyes in a solid do, beside a brightener.
Reradiation edgeMatrix(double follows) {
  Eigen::MatrixXd factors = madeFactors({MadeDye{360, 440, 0.5}});
  const std::vector<double> nm = madeBands();
  for (Eigen::Index i = 0; i < factors.cols(); ++i) {
    const double from = nm[static_cast<std::size_t>(i)];
    const MadeDye dye{510, 585 + follows * (from - 510), 0.7};
    double photons = 0;
    for (const double to : nm) {
      photons += dye.given(to);
    }
    factors(i, i) = std::max(factors(i, i) - dye.taken(from), 0.05);
    for (Eigen::Index o = i + 1; o < factors.rows(); ++o) {
      const double to = nm[static_cast<std::size_t>(o)];
      factors(o, i) += dye.yield * 0.6 * dye.taken(from) * dye.given(to) / photons * from / to;
    }
  }
  return {"edge", nm, nm, 0.9 * factors};
}

TEST(FluorescenceTest, FitLooksLikeItsMatrixUnderFiveLights) {
  FitColours colours{testLibrary().observer("CIE 1931 2").onDomain(), {}};
  for (const char* const light : {"D65", "A", "FL11", "HP1", "LED-RGB1"}) {
    colours.lights.push_back(onExcitation(testLibrary().illuminant(light)));
  }
  const auto differenceOf = [&](const Reradiation& matrix, const FluorescenceFit& fit) {
    double largest = 0;
    for (const ExcitationSamples& light : colours.lights) {
      const Eigen::Vector3d white = colours.curves.transpose() * light.tail<kDomainSize>();
      const auto labOf = [&](const FluorescentSamples& surface) {
        return lab(colourOf(surface, light, colours.curves), white / white.y());
      };
      largest = std::max(largest, deltaE2000(labOf(samplesOf(fit.surface)), labOf(samplesOf(matrix))));
    }
    return largest;
  };
  const Reradiation one = madeMatrix();
  // What is near by least squares stays as it is.
  EXPECT_EQ(fitFluorescence(one, colours).residual, fitFluorescence(one).residual);
  double before = 0;
  for (const double follows : {0.0, 0.1, 0.2}) {
    const Reradiation matrix = edgeMatrix(follows);
    const FluorescenceFit nearest = fitFluorescence(matrix);
    const FluorescenceFit fit = fitFluorescence(matrix, colours);
    std::printf("two dyes, emission follows by %.1f: CIEDE2000 %.2f -> %.2f, rms left %.2f -> %.2f\n", follows,
                differenceOf(matrix, nearest), differenceOf(matrix, fit), nearest.residual, fit.residual);
    EXPECT_LE(differenceOf(matrix, fit), 0.5);
    EXPECT_LE(samplesOf(fit.surface).mostPhotons(), 1.0 + 1e-9);
    before = std::max(before, differenceOf(matrix, nearest));
  }
  EXPECT_GT(before, 0.8);
}

TEST(FluorescenceTest, CompactFormComesBackFromItsFile) {
  const CompactFluorescence made = fitFluorescence(madeMatrix()).surface;
  const Fluorescence read = readFluorescenceTable(fluorescenceText(made), "made.csv");
  const FluorescentSamples before = samplesOf(made);
  const FluorescentSamples after = samplesOf(read);
  EXPECT_LT((before.perNm - after.perNm).cwiseAbs().maxCoeff(), 1e-6 * before.perNm.maxCoeff());
  EXPECT_LT((before.reflectance - after.reflectance).cwiseAbs().maxCoeff(), 1e-6);
}

CompactFluorescence compactOf(const std::vector<double>& reflectance, const std::vector<double>& excitation,
                              const std::vector<double>& emission, double quantumYield) {
  const auto curve = [](SpectralQuantity quantity, const std::vector<double>& values) {
    return Spectrum("dye", quantity, {400, 500, 600}, values);
  };
  return {"dye", curve(SpectralQuantity::Reflectance, reflectance), curve(SpectralQuantity::Sensitivity, excitation),
          curve(SpectralQuantity::Sensitivity, emission), quantumYield};
}

TEST(FluorescenceTest, CompactFormIsChecked) {
  EXPECT_TAKEN(samplesOf(compactOf({0.2, 0.5, 0.8}, {0.8, 0.5, 0}, {0, 1, 1}, 1.0)));
  EXPECT_REFUSED("quantum yield", samplesOf(compactOf({0, 0, 0}, {1, 1, 0}, {0, 1, 1}, 1.1)));
  EXPECT_REFUSED("together", samplesOf(compactOf({0.4, 0.5, 0.8}, {0.8, 0.5, 0}, {0, 1, 1}, 0.5)));
  EXPECT_REFUSED("excitation at 400", samplesOf(compactOf({0, 0, 0}, {1.5, 0, 0}, {0, 1, 1}, 0.5)));
  EXPECT_REFUSED("emission at 500", samplesOf(compactOf({0, 0, 0}, {1, 0, 0}, {0, -1, 1}, 0.5)));
  EXPECT_REFUSED("zero everywhere", samplesOf(compactOf({0, 0, 0}, {1, 0, 0}, {0, 0, 0}, 0.5)));
  // All photons at 450 nm that are taken come back, less energy.
  const FluorescentSamples all = samplesOf(compactOf({0, 0, 0}, {1, 1, 0}, {0, 0, 1}, 1.0));
  const Eigen::VectorXd back = all.perNm.col(450 - kExcitationStartNm);
  EXPECT_NEAR(all.mostPhotons(), 1.0, 0.01);
  EXPECT_NEAR(back.sum(), 450.0 / (500 + 200.0 / 3), 0.01);
}

TEST(FluorescenceTest, ReadsTables) {
  const Reradiation made = madeMatrix();
  const Reradiation read = matrixOf(readFluorescenceTable(csvOf(made), "made.csv"));
  EXPECT_EQ(read.factors(), made.factors());
  EXPECT_EQ(read.excitationNm(), made.excitationNm());
  const auto refused = [](const std::string& text) {
    return errorOf([&] { readFluorescenceTable(text, "made.csv"); });
  };
  EXPECT_EQ(refused("em/ex,400,410\n500,0.1\n510,0.1,0.1\n").find("made.csv:2: cells '2'"), 0U);
  EXPECT_NE(refused("em/ex,400,410\n400,nan,0\n410,0,0.3\n").find("made.csv:2: value 'nan'"), std::string::npos);
  EXPECT_NE(refused("em/ex,400,410\n400,0.3,0\n410,,0.3\n").find("is empty"), std::string::npos);
  EXPECT_NE(refused("em/ex,400,blue\n400,0.3,0\n410,0,0.3\n").find("made.csv:1: wavelength 'blue'"), std::string::npos);
  EXPECT_NE(refused("em/ex,400,410\n400,0.3,0\n").find("too few"), std::string::npos);
  EXPECT_NE(refused("").find("too few"), std::string::npos);
  EXPECT_NE(refused("quantum_yield,0.5\nwavelength_nm,reflectance,emission,excitation\n400,1,1,1\n").find("column 3"),
            std::string::npos);
  EXPECT_NE(refused("quantum_yield,x\nwavelength_nm,reflectance,excitation,emission\n400,1,0,0\n").find("'x'"),
            std::string::npos);
}

std::string bfcOf(const Reradiation& made) {
  std::string text = "VEC_01\t5167\r\nBFC-450 Matrix File\r\n\r\n300 780 10 49 300 10\r\nr:c:";
  for (const double nm : made.excitationNm()) {
    text += formatted("\t%g", nm);
  }
  for (Eigen::Index o = 0; o < made.factors().rows(); ++o) {
    text += formatted("\r\n%g ", made.emissionNm()[static_cast<std::size_t>(o)]);
    for (Eigen::Index i = 0; i < made.factors().cols(); ++i) {
      text += formatted("%.17g\t", made.factors()(o, i));
    }
    text += o == 20 ? "\r\n" : "";  // as instruments leave them
  }
  return text + "\r\nEOD\r\n1 2 3\r\n";
}

TEST(FluorescenceTest, ReadsBfc) {
  const Reradiation made = madeMatrix();
  const std::string text = bfcOf(made);
  const Reradiation read = readBfc(text, "made.bfc");
  EXPECT_EQ(read.factors(), made.factors());
  EXPECT_EQ(read.emissionNm(), made.emissionNm());
  EXPECT_REFUSED("cut short", readBfc(text.substr(0, text.find("\r\n450 ")), "made.bfc"));
  EXPECT_REFUSED("six whole numbers", readBfc("VEC_01\t5167\nBFC-450 Matrix File\n", "made.bfc"));
  std::string stray = text;
  stray.replace(stray.find("\r\n310 "), 5, "\r\n320");
  EXPECT_REFUSED("'320'", readBfc(stray, "made.bfc"));
}

TEST(FluorescenceTest, ReadsBispectralPictures) {
  const auto pair = channelPairNm("left.T.380,000000nm.0,4um");
  ASSERT_TRUE(pair.has_value());
  EXPECT_NEAR(pair->first, 380.0, 1e-9);
  EXPECT_NEAR(pair->second, 400.0, 1e-9);
  EXPECT_TRUE(channelPairNm("T.380.5nm.400.25nm").has_value());
  for (const char* other : {"T.400,000000nm", "S0.380nm.400nm", "T.380nm.red", "R", "T.380.400nm"}) {
    EXPECT_FALSE(channelPairNm(other)) << other;
  }
  bool isWhole = true;
  const auto reader = [&](const std::string&, const std::optional<PicturePlace>& place, const auto& isWanted) {
    EXPECT_TRUE(isWanted("T.400,000000nm"));
    EXPECT_FALSE(isWanted("S0.400,000000nm"));
    const double gain = place ? 0.5 : 1.0;
    std::vector<ChannelValue> values = {{"T.400,000000nm", 0.2 * gain},
                                        {"T.500,000000nm", 0.4},
                                        {"T.600,000000nm", 0.6},
                                        {"T.400,000000nm.500,000000nm", 0.1},
                                        {"T.500,000000nm.600,000000nm", 0.3}};
    if (isWhole) {
      values.push_back({"T.400,000000nm.600,000000nm", 0.05});
    }
    return values;
  };
  const Reradiation read = matrixOf(readFluorescence("paint.exr", reader));
  EXPECT_EQ(read.emissionNm(), (std::vector<double>{400, 500, 600}));
  EXPECT_EQ(read.factors()(2, 0), 0.05);
  EXPECT_EQ(read.factors()(0, 0), 0.2);
  EXPECT_EQ(read.factors()(0, 2), 0.0);
  EXPECT_EQ(matrixOf(readFluorescence("paint.exr:3,4", reader)).factors()(0, 0), 0.1);
  isWhole = false;
  EXPECT_REFUSED("400 to 600 nm", readFluorescence("paint.exr", reader));
  const auto plain = [](const std::string&, const auto&, const auto&) {
    return std::vector<ChannelValue>{{"T.400,000000nm", 0.2}, {"T.500,000000nm", 0.4}};
  };
  EXPECT_REFUSED("not bispectral", readFluorescence("paint.exr", plain));
  EXPECT_REFUSED("lutgen", readFluorescence("paint.exr"));
  EXPECT_REFUSED("extension", readFluorescence("paint.png"));
}

}  // namespace
}  // namespace metamer::spectral
