// SPDX-License-Identifier: Apache-2.0
// Every public function of skin that has a range, with arguments just outside it and just inside.
#include <gtest/gtest.h>

#include <limits>

#include "metamer/skin/layered_albedo.h"
#include "metamer/skin/random_walk.h"
#include "metamer/skin/skin_estimator.h"
#include "metamer/skin/skin_model.h"
#include "metamer/skin/skin_prior.h"
#include "metamer/skin/skin_table.h"
#include "spectral/refusals.h"

namespace metamer::skin {
namespace {

using spectral::testLibrary;

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr LayerOptics kUsual{3, 5, 150, 0.78, 0.01, 0.21};

template <typename Value>
LayerOptics with(Value LayerOptics::*field, Value value) {
  LayerOptics layers = kUsual;
  layers.*field = value;
  return layers;
}

TEST(SkinRanges, Layers) {
  EXPECT_TAKEN(layeredAlbedo(kUsual));
  EXPECT_TAKEN(layeredAlbedo(with(&LayerOptics::dermisThicknessCm, kInfinite)));
  EXPECT_TAKEN(layeredAlbedo(with(&LayerOptics::epidermisThicknessCm, 0.0)));
  const auto refused = [](const char* what, const LayerOptics& layers) {
    EXPECT_REFUSED(what, layeredAlbedo(layers));
    EXPECT_REFUSED(what, layeredAlbedoByPlainDoubling(layers, 4));
    double albedo = 0;
    EXPECT_REFUSED(what, layeredAlbedoGrid({{layers.epidermisAbsorption},
                                            {layers.dermisAbsorption},
                                            layers.scattering,
                                            layers.anisotropy,
                                            layers.epidermisThicknessCm,
                                            layers.dermisThicknessCm},
                                           {&albedo, 1}));
    EXPECT_REFUSED(what, walkedAlbedo(layers, WalkSpace::Three, 10, 1));
  };
  refused("epidermis absorption '-1'", with(&LayerOptics::epidermisAbsorption, -1.0));
  refused("dermis absorption 'nan'", with(&LayerOptics::dermisAbsorption, kNotANumber));
  refused("scattering '0'", with(&LayerOptics::scattering, 0.0));
  refused("anisotropy '1'", with(&LayerOptics::anisotropy, 1.0));
  refused("anisotropy '-0.1'", with(&LayerOptics::anisotropy, -0.1));
  refused("epidermis thickness 'inf'", with(&LayerOptics::epidermisThicknessCm, kInfinite));
  refused("dermis thickness '-1'", with(&LayerOptics::dermisThicknessCm, -1.0));
  EXPECT_REFUSED("streams per hemisphere '1'", layeredAlbedoByPlainDoubling(kUsual, 1));
  EXPECT_REFUSED("streams per hemisphere '33'", layeredAlbedoByPlainDoubling(kUsual, 33));
  EXPECT_REFUSED("paths '1'", walkedAlbedo(kUsual, WalkSpace::Two, 1, 1));
  double one = 0;
  EXPECT_REFUSED("albedos '1'", layeredAlbedos({}, {&one, 1}));
  EXPECT_REFUSED("albedos '1'", layeredAlbedoGrid({{1, 2}, {1}, 150, 0.78, 0.01}, {&one, 1}));
  EXPECT_TAKEN(layeredAlbedoGrid({{1}, {1}, 150, 0.78, 0.01}, {&one, 1}));
}

TEST(SkinRanges, Skins) {
  const SkinModel model(testLibrary());
  const SkinTable table(model);
  const auto refused = [&](const char* what, const SkinParameters& skin) {
    EXPECT_REFUSED(what, model.albedo(skin));
    EXPECT_REFUSED(what, table.albedo(skin));
    EXPECT_TAKEN(model.albedo(withinRanges(skin)));
  };
  EXPECT_TAKEN(model.albedo({0, 0, 10, 0, 0}));
  EXPECT_TAKEN(model.albedo({1, 1, 350, 1, 1}));
  refused("melanin '-0.1'", {-0.1, 0.02, 100, 0.5, 0.5});
  refused("melanin 'nan'", {kNotANumber, 0.02, 100, 0.5, 0.5});
  refused("blood '1.1'", {0.1, 1.1, 100, 0.5, 0.5});
  refused("thickness '9'", {0.1, 0.1, 9, 0.5, 0.5});
  refused("thickness '351'", {0.1, 0.1, 351, 0.5, 0.5});
  refused("eumelanin '2'", {0.1, 0.1, 100, 2, 0.5});
  refused("deoxyhaemoglobin '-1'", {0.1, 0.1, 100, 0.5, -1});
}

TEST(SkinRanges, Models) {
  EXPECT_TAKEN(SkinModel(testLibrary(), {380, 780}));
  EXPECT_REFUSED("wavelengths '0'", SkinModel(testLibrary(), {}));
  EXPECT_REFUSED("wavelength '379'", SkinModel(testLibrary(), {379}));
  EXPECT_REFUSED("wavelength '781'", SkinModel(testLibrary(), {781}));
  EXPECT_REFUSED("dermis thickness '0'", SkinModel(testLibrary(), {500}, 0));
  EXPECT_REFUSED("dermis thickness 'nan'", SkinModel(testLibrary(), {500}, kNotANumber));
  EXPECT_REFUSED("wavelengths '1'", SkinTable(SkinModel(testLibrary(), {500})));
  EXPECT_REFUSED("chromophore 'keratin'", testLibrary().chromophore("keratin"));
}

TEST(SkinRanges, Draws) {
  const SkinPrior prior = SkinPrior::read(testLibrary());
  EXPECT_TAKEN(sampleSkins(prior, 0, 1));
  EXPECT_REFUSED("count '-1'", sampleSkins(prior, -1, 1));
  EXPECT_REFUSED("count '1000001'", sampleSkins(prior, 1'000'001, 1));
  EXPECT_REFUSED("count '-1'", virtualSkins(testLibrary(), -1, 1));
}

TEST(SkinRanges, Views) {
  const spectral::Observer eye = testLibrary().observer("CIE 1931 2");
  const spectral::RgbSpace space = testLibrary().colourSpace("Rec.709").linear;
  const spectral::Spectrum light = testLibrary().illuminant("D65");
  spectral::Observer camera = eye;
  camera.xyzFromResponse.reset();
  EXPECT_REFUSED("observer 'CIE 1931 2'", SkinView(light, camera, space));
  camera.xyzFromResponse = Eigen::Matrix3d::Zero();
  EXPECT_NE(spectral::errorOf([&] { SkinView(light, camera, space); }), "no InputError");
  const spectral::Spectrum dark("dark", spectral::SpectralQuantity::SpectralPowerDistribution, {380, 780}, {0, 0});
  EXPECT_REFUSED("illuminant 'dark'", SkinView(dark, eye, space));
  const SkinView view(light, eye, space);
  EXPECT_REFUSED("threads '0'", SkinEstimator(testLibrary(), view, 0));
  EXPECT_REFUSED("threads '257'", SkinEstimator(testLibrary(), view, 257));
  const SkinEstimator estimator(testLibrary(), view);
  std::vector<SkinPixel> two(2);
  std::vector<float> rgb(6, 0.3F);
  EXPECT_TAKEN(estimator.estimate(rgb, two));
  EXPECT_REFUSED("rgb '6'", estimator.estimate(rgb, {two.data(), 1}));
  EXPECT_REFUSED("rgb '5'", estimator.colour(two, {rgb.data(), 5}));
  EXPECT_REFUSED("threads '0'", estimator.estimate(rgb, two, 0));
}

}  // namespace
}  // namespace metamer::skin
