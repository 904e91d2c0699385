// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/reradiation.h"

#include <gtest/gtest.h>

#include <limits>

#include "metamer/spectral/spectral_integral.h"
#include "spectral/fluorescence/made_matrix.h"
#include "spectral/refusals.h"

namespace metamer::spectral {
namespace {

using Quantity = SpectralQuantity;

Reradiation matrixWith(Eigen::Index o, Eigen::Index i, double value) {
  Eigen::MatrixXd factors = madeFactors({MadeDye{}});
  factors(o, i) = value;
  return {"made", madeBands(), madeBands(), factors};
}

TEST(ReradiationTest, KeepsWhatComesBack) {
  const Reradiation matrix = madeMatrix({MadeDye{}, MadeDye{360, 430, 0.9}});
  const FluorescentSamples samples = samplesOf(matrix);
  EXPECT_LE(samples.mostEnergy(), samples.mostPhotons());
  EXPECT_LE(samples.mostPhotons(), 1.0 + 1e-12);
  EXPECT_LE(matrix.balance().photons, 1.0);
  // Nothing at or below its excitation.
  EXPECT_EQ(samples.perNm.triangularView<Eigen::Upper>().toDenseMatrix().cwiseAbs().maxCoeff(), 0.0);
  EXPECT_GE(samples.perNm.minCoeff(), 0.0);
  // Photons of a band's middle are those of its samples, whatever interpolation does near the diagonal.
  for (const int k : {0, 3, 9, 15}) {
    double wanted = 0;
    double got = 0;
    for (int o = k + 1; o < 49; ++o) {
      wanted += matrix.factors()(o, k) * (300 + 10 * o);
    }
    for (int o = 0; o < kExcitationSize; ++o) {
      got += samples.perNm(o, 10 * k) * (kExcitationStartNm + o);
    }
    EXPECT_NEAR(got / wanted, 1.0, 2e-3) << k;
  }
}

TEST(ReradiationTest, ReflectsAsItsDiagonalWithoutADye) {
  const Eigen::MatrixXd diagonal = 0.4 * Eigen::MatrixXd::Identity(49, 49);
  const FluorescentSamples samples = samplesOf(Reradiation("grey", madeBands(), madeBands(), diagonal));
  const ExcitationSamples light = onExcitation(testLibrary().illuminant("D65"));
  EXPECT_LT((samples.givenBack(light) - 0.4 * light).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(ReradiationTest, BrighterThanWhiteWhereItEmits) {
  const ExcitationSamples light = onExcitation(testLibrary().illuminant("D65"));
  const ExcitationSamples back = samplesOf(madeMatrix()).givenBack(light);
  // Day-glo: more light at its emission than a perfect reflector gives.
  EXPECT_GT(back[520 - kExcitationStartNm] / light[520 - kExcitationStartNm], 1.0);
}

TEST(ReradiationTest, LightIsReadFrom300Nm) {
  const ExcitationSamples d65 = onExcitation(testLibrary().illuminant("D65"));
  EXPECT_NEAR(d65[0], 0.0341, 1e-9);  // the CIE's table at 300 nm
  EXPECT_EQ(d65[kDomainInExcitation], testLibrary().illuminant("D65").onDomain()[0]);
  EXPECT_GT(onExcitation(testLibrary().illuminant("daylight 4000 K")).minCoeff(), 0.0);
  EXPECT_EQ(onExcitation(testLibrary().illuminant("FL11")).head<kDomainInExcitation>().maxCoeff(), 0.0);
  // A line of any width has its energy, at the end of the range as well.
  for (const double line : {365.02, 379.6}) {
    const Spectrum laser("laser", Quantity::SpectralPowerDistribution, {line - 0.05, line, line + 0.05}, {0, 40, 0});
    EXPECT_NEAR(onExcitation(laser).sum(), 2.0, 1e-9) << line;
  }
  const Spectrum wall("wall", Quantity::Reflectance, {400, 700}, {0.2, 0.6});
  EXPECT_EQ(onExcitation(wall)[0], 0.2);
}

TEST(ReradiationTest, NoiseIsSetToZeroAndSaid) {
  EXPECT_TRUE(madeMatrix().notes().empty());
  const Reradiation noisy = matrixWith(20, 40, 0.01);
  EXPECT_EQ(noisy.factors()(20, 40), 0.0);
  ASSERT_EQ(noisy.notes().size(), 1U);
  EXPECT_NE(noisy.notes()[0].find("1 value"), std::string::npos) << noisy.notes()[0];
  EXPECT_EQ(matrixWith(40, 20, -0.01).notes().size(), 1U);
}

TEST(ReradiationTest, RefusesWhatNoSurfaceDoes) {
  EXPECT_REFUSED("below its excitation", matrixWith(20, 40, 0.1));
  EXPECT_REFUSED("700 nm to 500 nm", matrixWith(20, 40, 0.1));
  EXPECT_REFUSED("must not be negative", matrixWith(40, 20, -0.1));
  EXPECT_REFUSED("finite", matrixWith(40, 20, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_REFUSED("finite", matrixWith(20, 20, std::numeric_limits<double>::infinity()));
  // Energy is kept, photons are not: 0.95 of the energy of 400 nm at 700 nm.
  Eigen::MatrixXd factors = Eigen::MatrixXd::Zero(49, 49);
  factors.diagonal().setConstant(0.01);
  factors(40, 10) = 0.95;
  EXPECT_REFUSED("photons", Reradiation("made", madeBands(), madeBands(), factors));
  factors(40, 10) = 0.55;
  EXPECT_TAKEN(Reradiation("made", madeBands(), madeBands(), factors));
  EXPECT_REFUSED("percent", Reradiation("made", madeBands(), madeBands(), 100.0 * factors));
}

TEST(ReradiationTest, RefusesGapsAndStrayAxes) {
  std::vector<double> gap = madeBands();
  gap.erase(gap.begin() + 20);
  const Eigen::MatrixXd whole = madeFactors({MadeDye{}});
  EXPECT_REFUSED("490 to 510", Reradiation("made", gap, madeBands(), whole.leftCols(48)));
  EXPECT_REFUSED("gap", Reradiation("made", madeBands(), gap, whole.topRows(48)));
  std::vector<double> moved = madeBands();
  for (double& nm : moved) {
    nm += 3;
  }
  EXPECT_REFUSED("grid", Reradiation("made", madeBands(), moved, whole));
  EXPECT_REFUSED("two wavelengths", Reradiation("made", {400}, madeBands(), whole.leftCols(1)));
  EXPECT_REFUSED("above the one before", Reradiation("made", {410, 400}, madeBands(), whole.leftCols(2)));
  EXPECT_REFUSED("row an emission", Reradiation("made", madeBands(), madeBands(), whole.topRows(3)));
  // Emissions from 700 nm, excitations to 400 nm: no wavelength is both.
  EXPECT_REFUSED("reflectance",
                 samplesOf(Reradiation("made", {390, 400}, {700, 710}, Eigen::MatrixXd::Constant(2, 2, 0.1))));
}

}  // namespace
}  // namespace metamer::spectral
