// SPDX-License-Identifier: Apache-2.0
#include "metamer/skin/skin_model.h"

#include <gtest/gtest.h>

#include <limits>

#include "metamer/skin/skin_table.h"
#include "spectral/fixture.h"

namespace metamer::skin {
namespace {

using spectral::MaxDifference;
using spectral::testLibrary;
using spectral::unitRandom;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

TEST(SkinModel, GivesTheValuesOfATrialOfItsOwn) {
  // An independent trial of the model (adding-doubling of its own, matched index, infinite dermis), printed to three
  // digits; 2e-3 is what its 3-D walk left open.
  const SkinModel model(testLibrary(), {500, 542, 560, 577, 650, 700}, kInfinite);
  const Eigen::VectorXd albedo = model.albedo({0.008, 0.02, 100, 0.7, 0.25});
  const std::array<double, 6> expected = {0.460, 0.393, 0.420, 0.391, 0.641, 0.676};
  MaxDifference difference("six values", 2e-3);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    difference.add(albedo[static_cast<Eigen::Index>(i)], expected[i]);
  }
}

TEST(SkinModel, FlattensTheWWithMelanin) {
  // The same trial: haemoglobin's W (fig. 3.4), R(560) less the mean of 542 and 577 nm.
  const SkinModel model(testLibrary(), {542, 560, 577}, kInfinite);
  const std::array<std::array<double, 2>, 4> expected = {{{0.008, 0.028}, {0.02, 0.023}, {0.1, 0.008}, {0.3, 0.0006}}};
  MaxDifference difference("contrast of the W", 2e-3);
  for (const auto& [melanin, contrast] : expected) {
    const Eigen::VectorXd albedo = model.albedo({melanin, 0.02, 100, 0.7, 0.25});
    difference.add(albedo[1] - (albedo[0] + albedo[2]) / 2, contrast);
  }
}

TEST(SkinModel, AbsorbsInTheUnitsOfItsTable) {
  // Blood of 150 g/l with oxygen at 542 nm: 5.356e-3 times the molar extinction; the baseline at 500 nm.
  const SkinOptics optics(testLibrary(), {500, 542, 380, 780});
  EXPECT_NEAR(optics.oxyhaemoglobin()[1], 285.4, 0.3);
  EXPECT_NEAR(optics.baseline()[0], 1.29, 0.005);
  EXPECT_NEAR(optics.reducedScattering()[0], 36.4, 1e-12);
  EXPECT_NEAR(optics.reducedScattering()[2], 72.5, 0.05);
  EXPECT_NEAR(optics.reducedScattering()[3], 20.1, 0.05);
  EXPECT_NEAR(optics.anisotropy()[2], 0.7302, 1e-12);
  EXPECT_NEAR(optics.anisotropy()[3], 0.8462, 1e-12);
}

TEST(SkinModel, TenNanometresAreEnough) {
  // Section 3.2, fig. 3.4: the spectrum between its 10 nm bands, against 2 nm.
  std::vector<double> fine;
  for (double nm = 380; nm <= 780; nm += 2) {
    fine.push_back(nm);
  }
  const SkinModel model(testLibrary());
  const SkinModel reference(testLibrary(), fine);
  for (const double melanin : {0.01, 0.05, 0.3}) {
    const Eigen::VectorXd coarse = model.albedo({melanin, 0.02, 100, 0.5, 0.3});
    const Eigen::VectorXd truth = reference.albedo({melanin, 0.02, 100, 0.5, 0.3});
    double squares = 0;
    for (std::size_t i = 0; i < fine.size(); ++i) {
      const double at = (fine[i] - 380) / kSkinBandNm;
      const auto band = std::min(static_cast<Eigen::Index>(at), Eigen::Index{kSkinBands - 2});
      const double between = at - static_cast<double>(band);
      const double value = coarse[band] + between * (coarse[band + 1] - coarse[band]);
      squares += std::pow(value - truth[static_cast<Eigen::Index>(i)], 2);
    }
    EXPECT_LT(std::sqrt(squares / static_cast<double>(fine.size())), 3e-3) << melanin;
  }
}

TEST(SkinTable, IsTheModelWithinAThousandth) {
  const SkinModel model(testLibrary());
  const SkinTable table(model);
  std::mt19937 random(3);
  double squares = 0;
  MaxDifference difference("table against model, largest", 2.5e-3);
  constexpr int kSkins = 400;
  for (int i = 0; i < kSkins; ++i) {
    SkinCoordinates at;
    for (Eigen::Index k = 0; k < 5; ++k) {
      at[k] = lowestCoordinates()[k] + (highestCoordinates()[k] - lowestCoordinates()[k]) * unitRandom(random);
    }
    const SkinParameters skin = skinOf(at);
    const SkinSpectrum read = table.albedo(skin);
    const Eigen::VectorXd solved = model.albedo(skin);
    squares += (read - solved).squaredNorm() / kSkinBands;
    difference.add(read, solved);
  }
  const double rms = std::sqrt(squares / kSkins);
  std::printf("[ table against model ] rms %.2g\n", rms);
  EXPECT_LE(rms, 1e-3);
}

TEST(SkinTable, HoldsAtItsBorders) {
  const SkinModel model(testLibrary());
  const SkinTable table(model);
  MaxDifference difference("table at the corners", 1e-3);
  for (int corner = 0; corner < 32; ++corner) {
    const auto side = [&](int bit) { return (corner & bit) != 0 ? 1.0 : 0.0; };
    const SkinParameters skin{side(1), side(2), side(4) > 0 ? kThickestEpidermisUm : kThinnestEpidermisUm, side(8),
                              side(16)};
    difference.add(table.albedo(skin), model.albedo(skin));
  }
}

}  // namespace
}  // namespace metamer::skin
