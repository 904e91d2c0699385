// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "metamer/skin/skin_prior.h"
#include "spectral/refusals.h"
#include "spectral_ref/scene_fixture.h"

namespace metamer::spectral_ref {
namespace {

using spectral::testLibrary;

/// A wall of skin that fills the view, in even light.
std::string wallOf(const std::string& material) {
  return "metamer_scene: 1\n"
         "film: {width: 16, height: 16, bins: {from: 380, to: 780, step: 20}}\n"
         "camera: {origin: [0, 0, 4], target: [0, 0, 0], up: [0, 1, 0], fov_x: 40}\n"
         "integrator: {max_depth: 2, wavelengths: 4}\n"
         "lights: [{environment: {emission: 1}}]\n"
         "shapes:\n"
         "  - rectangle: {center: [0, 0, 0], half_u: [9, 0, 0], half_v: [0, 9, 0]}\n    " +
         material + "\n";
}

skin::SkinSpectrum albedoOf(const skin::SkinParameters& parameters) {
  return skin::repaired(skin::SkinModel(testLibrary()).albedo(parameters), skin::SkinPrior::read(testLibrary()));
}

TEST(SkinMaterial, HasTheModelsAlbedo) {
  const Scene scene =
      sceneOf(wallOf("skin: {melanin: 0.08, blood: 0.03, thickness: 120, melanin_type: 0.6, deoxygenation: 0.3}"));
  ASSERT_EQ(scene.materials.size(), 1U);
  EXPECT_EQ(scene.materials[0].kind, Material::Kind::Diffuse);
  const skin::SkinSpectrum expected = albedoOf({0.08, 0.03, 120, 0.6, 0.3});
  for (int band = 0; band < skin::kSkinBands; ++band) {
    EXPECT_NEAR(scene.spectra[scene.materials[0].colour][10 * band], expected[band], 1e-12);
  }
}

TEST(SkinMaterial, IsRenderedWithIt) {
  const Film film = rendered(sceneOf(wallOf("skin: {melanin: 0.02, blood: 0.04}")), 512);
  const Film white = rendered(sceneOf(wallOf("diffuse: 1")), 512);
  skin::SkinParameters parameters = skin::skinOf(skin::SkinPrior::read(testLibrary()).mean);
  parameters.melanin = 0.02;
  parameters.blood = 0.04;
  const skin::SkinSpectrum expected = albedoOf(parameters);
  for (int bin = 1; bin + 1 < film.format().bins.count; ++bin) {
    // A bin's mean over 20 nm of what is linear between tens.
    const int band = 2 * bin;
    const double mean = (expected[band - 1] + 2 * expected[band] + expected[band + 1]) / 4;
    // Wavelengths drawn within the bin: 130,000 paths leave less than that.
    EXPECT_NEAR(meanRadiance(film, bin) / meanRadiance(white, bin), mean, 2e-3) << film.format().bins.centreNm(bin);
  }
}

TEST(SkinMaterial, RefusesWhatNoSkinIs) {
  EXPECT_REFUSED("blood", sceneOf(wallOf("skin: {blood: 2}")));
  EXPECT_REFUSED("thickness", sceneOf(wallOf("skin: {thickness: 5}")));
  EXPECT_REFUSED("freckles", sceneOf(wallOf("skin: {freckles: 1}")));
  EXPECT_REFUSED("another material", sceneOf(wallOf("skin: {blood: 0.1}\n    diffuse: 1")));
}

}  // namespace
}  // namespace metamer::spectral_ref
