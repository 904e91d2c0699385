// SPDX-License-Identifier: Apache-2.0
#include "pairs/several_lights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "metamer/sip/pairs.h"
#include "metamer/sip/smoothest_spectrum.h"
#include "metamer/spectral/colorimetry.h"
#include "metamer/spectral/fluorescence.h"
#include "metamer/spectral/reradiation.h"
#include "sip/sip_fixture.h"
#include "spectral/temporary_folder.h"

namespace metamer::sip {
namespace {

constexpr int kBands = 81;

Eigen::MatrixXd weightsOf(const std::vector<std::string>& lights) {
  Eigen::MatrixXd weights(3 * static_cast<Eigen::Index>(lights.size()), kBands);
  for (std::size_t k = 0; k < lights.size(); ++k) {
    weights.middleRows<3>(3 * static_cast<Eigen::Index>(k)) = normalisedWeights(lights[k], kBands);
  }
  return weights;
}

double roughnessOf(const Eigen::VectorXd& spectrum) {
  return (spectrum.tail(kBands - 1) - spectrum.head(kBands - 1)).squaredNorm();
}

TEST(SeveralLightsTest, MeetsAllColoursOfMeasuredSurfaces) {
  const std::vector<std::vector<std::string>> all = {{"D65"}, {"D65", "A"}, {"D65", "A", "FL11"}, {"D65", "D65"}};
  const Eigen::MatrixXd surfaces = onBands(samplesOf("tm30"), kBands);
  for (const auto& lights : all) {
    const Eigen::MatrixXd weights = weightsOf(lights);
    for (Eigen::Index k = 0; k < surfaces.cols(); k += 3) {
      const SeveralLights solved = smoothestUnder(weights, weights * surfaces.col(k));
      ASSERT_LE(solved.missed, kMetColour) << lights.size() << " lights, surface " << k;
      ASSERT_LE((weights * (solved.reflectance - surfaces.col(k))).cwiseAbs().maxCoeff(), kMetColour);
      ASSERT_GE(solved.reflectance.minCoeff(), 0.0);
      ASSERT_LE(solved.reflectance.maxCoeff(), 1.0);
      // The surface itself has the colours, so the smoothest is no rougher.
      ASSERT_LE(roughnessOf(solved.reflectance), roughnessOf(surfaces.col(k)) + 1e-12);
    }
  }
}

/// Under one light it is the smoothest spectrum within hard bounds, by another method.
TEST(SeveralLightsTest, OneLightAgainstTheActiveSets) {
  const Eigen::Matrix3Xd weights = normalisedWeights("D65", kBands);
  const SmoothestSpectrumSolver solver(weights, SmoothestSpectrumSolver::UpperBound::One);
  int bounded = 0;
  for (const Eigen::Vector3d& colour : feasibleTristimuli(weights, 40)) {
    const auto expected = solver.solve(0.9 * colour);
    if (!expected) {
      EXPECT_GT(smoothestUnder(weights, 0.9 * colour).missed, kMetColour);
      continue;
    }
    bounded += expected->active.empty() ? 0 : 1;
    EXPECT_LE((smoothestUnder(weights, 0.9 * colour).reflectance - expected->reflectance).cwiseAbs().maxCoeff(), 1e-5);
  }
  EXPECT_GT(bounded, 10);
}

TEST(SeveralLightsTest, BlackWhiteAndWhatCannotBe) {
  const Eigen::MatrixXd weights = weightsOf({"D65", "A"});
  for (const double level : {0.0, 0.5, 1.0}) {
    const Eigen::VectorXd grey = Eigen::VectorXd::Constant(kBands, level);
    const SeveralLights solved = smoothestUnder(weights, weights * grey);
    EXPECT_LE(solved.missed, kMetColour) << level;
    EXPECT_LE((solved.reflectance - grey).cwiseAbs().maxCoeff(), 1e-4) << level;
  }
  // Grey under one light and red under the other.
  Eigen::VectorXd colours = weights * Eigen::VectorXd::Constant(kBands, 0.5);
  colours.tail<3>() = Eigen::Vector3d(0.6, 0.4, 0.1);
  const SeveralLights solved = smoothestUnder(weights, colours);
  EXPECT_GT(solved.missed, 0.01);
  // No mixture with a measured surface comes nearer: the misses are least.
  const double least = (weights * solved.reflectance - colours).squaredNorm();
  for (const auto& surface : samplesOf("tm30")) {
    const Eigen::VectorXd step = 1e-3 * (atBandCentres(surface, kBands) - solved.reflectance);
    EXPECT_GE((weights * (solved.reflectance + step) - colours).squaredNorm(), least - 1e-7);
  }
}

/// A dye that takes violet and gives it back as green: brighter than white in a band.
TEST(SeveralLightsTest, FluorescentSurfacesLookAsTheyDoUnderEachLight) {
  const auto curve = [](spectral::SpectralQuantity quantity, double middle, double width, double most) {
    std::vector<double> nm;
    std::vector<double> values;
    for (int k = spectral::kExcitationStartNm; k <= 780; k += 5) {
      nm.push_back(k);
      values.push_back(most * std::exp(-0.5 * std::pow((k - middle) / width, 2)));
    }
    return spectral::Spectrum("dye", quantity, nm, values);
  };
  const spectral::FluorescentSamples surface = spectral::samplesOf(
      spectral::CompactFluorescence{.name = "vest",
                                    .reflectance = curve(spectral::SpectralQuantity::Reflectance, 610, 20, 0.9),
                                    .excitation = curve(spectral::SpectralQuantity::Sensitivity, 440, 40, 0.95),
                                    .emission = curve(spectral::SpectralQuantity::Sensitivity, 530, 8, 1),
                                    .quantumYield = 0.9});
  const auto curves = testLibrary().observer("CIE 1931 2").onDomain();
  const auto coloursUnder = [&](const std::vector<std::string>& lights) {
    std::vector<PairColour> colours;
    for (const std::string& light : lights) {
      colours.push_back(
          {light, spectral::colourOf(surface, spectral::onExcitation(testLibrary().illuminant(light)), curves)});
    }
    return colours;
  };
  const auto colours = coloursUnder({"D65", "HP1"});
  const Pair vest = reflectanceOf("vest", colours, testLibrary(), "here", {}, kFluorescentBrightest);
  EXPECT_GT(vest.reflectance.maxCoeff(), 1.0);
  for (const PairColour& colour : colours) {
    const auto light = testLibrary().illuminant(colour.light).onDomain();
    const Eigen::Vector3d made = curves.transpose() * light.cwiseProduct(vest.reflectance) / curves.col(1).dot(light);
    EXPECT_LE((made - colour.xyz).cwiseAbs().maxCoeff(), 1e-6) << colour.light;
  }
  EXPECT_NE(errorOf([&] { reflectanceOf("vest", colours, testLibrary(), "here"); }).find("no one reflectance"),
            std::string::npos);
  // Daylight and tungsten are too alike: what glows in one and not in the other is no spectrum's.
  EXPECT_NE(errorOf([&] {
              reflectanceOf("vest", coloursUnder({"D65", "A"}), testLibrary(), "here", {}, kFluorescentBrightest);
            }).find("no one reflectance"),
            std::string::npos);
}

class PairFilesTest : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) {
    const std::filesystem::path file = m_folder.path() / "costume.csv";
    std::ofstream(file) << text;
    return file;
  }
  std::string error(const std::string& text) {
    return errorOf([&] { readPairs(write(text).string(), testLibrary()); });
  }
  TemporaryFolder m_folder;
};

TEST_F(PairFilesTest, TablesOfColoursAndOfSpectra) {
  const auto spectra = readPairs(write("wavelength_nm,coat,hat\n380,0.1,0.5\n780,0.3,0.5\n").string(), testLibrary());
  ASSERT_EQ(spectra.size(), 2U);
  EXPECT_EQ(spectra[0].name, "coat");
  EXPECT_NEAR(spectra[0].reflectance[200], 0.2, 1e-12);
  EXPECT_EQ(readPairs("colorchecker", testLibrary()).size(), 24U);
  const std::string one = write("wavelength_nm,coat,hat\n380,0.1,0.5\n780,0.3,0.5\n").string() + ":hat";
  EXPECT_EQ(readPairs(one, testLibrary()).size(), 1U);

  const auto colours =
      readPairs(write("# measured\npair,light,X,Y,Z\ncoat,D65,0.25,0.2,0.1\ncoat,A,0.33,0.24,0.036\n\"grey, hat\",A,"
                      "0.54925,0.5,0.17793\n")
                    .string(),
                testLibrary());
  ASSERT_EQ(colours.size(), 2U);
  EXPECT_EQ(colours[1].name, "grey, hat");
  for (const auto& [light, xyz] :
       {std::pair("D65", Eigen::Vector3d(0.25, 0.2, 0.1)), std::pair("A", Eigen::Vector3d(0.33, 0.24, 0.036))}) {
    const Eigen::Matrix3Xd weights = normalisedWeights(light, kConvergedBandCount);
    const Eigen::Vector3d white =
        spectral::response(testLibrary().illuminant(light), testLibrary().observer("CIE 1931 2"));
    const Eigen::Vector3d made = (white / white.y()).cwiseProduct(weights * colours[0].reflectance);
    EXPECT_LE((made - xyz).cwiseAbs().maxCoeff(), 1e-9) << light;
  }
  const auto lab = readPairs(write("pair,light,L*,a*,b*\nhat,D65,50,0,0\n").string(), testLibrary());
  EXPECT_LE((lab[0].reflectance.array() - 0.184187).abs().maxCoeff(), 1e-5);
}

TEST_F(PairFilesTest, OneLineForWhatIsWrong) {
  const auto expect = [&](const std::string& text, const std::string& message) {
    EXPECT_NE(error(text).find(message), std::string::npos) << error(text);
  };
  expect("pair,light,R,G,B\n", "costume.csv:1: heading 'pair, light, R, G, B': must be pair,light,X,Y,Z or");
  expect("pair,light,X,Y,Z\n", "costume.csv: pairs '0': must be from 1 to 16384");
  expect("pair,light,X,Y,Z\ncoat,D65,0.2,0.2\n", "costume.csv:2: row 'coat, D65, 0.2, 0.2': needs five cells");
  expect("pair,light,X,Y,Z\ncoat,D65,0.2,nan,1\n", "costume.csv:2: Y 'nan': must be a finite number");
  expect("pair,light,X,Y,Z\ncoat,D66,0.2,0.2,0.2\n", "'D66': unknown");
  expect("pair,light,X,Y,Z\ncoat,D65,20,20,20\n", "coat under D65 '20 20 20': X, Y and Z must be from 0 to 2");
  expect("pair,light,X,Y,Z\ncoat,D65,0.2,-0.2,0.2\n", "coat under D65 '0.2 -0.2 0.2': X, Y and Z must be from 0 to 2");
  expect("pair,light,X,Y,Z\ncoat,D65,1.2,1.2,1.2\n", "coat '1.2 1.2 1.2 under D65': no reflectance has this colour; ");
  expect("pair,light,X,Y,Z\ncoat,D65,.475,.5,.544\ncoat,A,.6,.4,.05\n",
         "no one reflectance has its colours; the nearest has X Y Z ");
}

}  // namespace
}  // namespace metamer::sip
