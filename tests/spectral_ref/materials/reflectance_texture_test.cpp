// SPDX-License-Identifier: Apache-2.0
#include "materials/reflectance_texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "metamer/sip/scene_uplift.h"
#include "metamer/spectral/colorimetry.h"
#include "spectral/refusals.h"
#include "spectral/temporary_folder.h"
#include "spectral_ref/picture_fixture.h"
#include "spectral_ref/scene_fixture.h"

namespace metamer::spectral_ref {
namespace {

using spectral::testLibrary;

/// Three by two pixels with nodes at the ends alone; values of no two are alike.
Texture sixPixels(Texture::Wrap wrap) {
  Texture texture;
  texture.picture = {3, 2, {380, 780}, {}};
  for (int pixel = 0; pixel < 6; ++pixel) {
    texture.picture.values.push_back(static_cast<std::uint16_t>(6553 * (pixel + 1)));
    texture.picture.values.push_back(static_cast<std::uint16_t>(6553 * (pixel + 4)));
  }
  texture.wrap = wrap;
  return texture;
}

/// What sixPixels() has at a pixel, and from 380 to 780 nm.
double pixelOf(int x, int y, double share) {
  return 6553 * (3 * y + x + 1 + 3 * share) / 65535;
}

Hit hitAt(double u, double v) {
  Hit hit;
  hit.u = static_cast<float>(u);
  hit.v = static_cast<float>(v);
  return hit;
}

WavelengthSet<4> fourWavelengths() {
  WavelengthSet<4> set{};
  set.cell = {0, 100, 400, -40};
  return set;
}

void expectPixel(const ReflectanceTexture& texture, const Hit& hit, double first, double last, const char* what) {
  const Lanes<4> found = texture.at<4>(hit, fourWavelengths());
  EXPECT_NEAR(found[0], first, 1e-6) << what;
  EXPECT_NEAR(found[1], 0.75 * first + 0.25 * last, 1e-6) << what;
  EXPECT_NEAR(found[2], last, 1e-6) << what;
  EXPECT_NEAR(found[3], first, 1e-6) << what << ": ultraviolet";
}

TEST(ReflectanceTextureTest, LiesOnARectangleUprightAndOnce) {
  const Texture picture = sixPixels(Texture::Wrap::Rectangle);
  const ReflectanceTexture texture(picture);
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 3; ++x) {
      expectPixel(texture, hitAt((x + 0.5) / 3, 1 - (y + 0.5) / 2), pixelOf(x, y, 0), pixelOf(x, y, 1), "middle");
    }
  }
  expectPixel(texture, hitAt(0, 1), pixelOf(0, 0, 0), pixelOf(0, 0, 1), "corner");
  expectPixel(texture, hitAt(1, 0), pixelOf(2, 1, 0), pixelOf(2, 1, 1), "other corner");
  expectPixel(texture, hitAt(1.0 / 3, 0.5), (pixelOf(0, 0, 0) + pixelOf(1, 1, 0)) / 2,
              (pixelOf(0, 0, 1) + pixelOf(1, 1, 1)) / 2, "between four");
}

TEST(ReflectanceTextureTest, LiesOnASphereAsFromOutside) {
  Texture picture = sixPixels(Texture::Wrap::Sphere);
  picture.center = {1, 2, 3};
  const ReflectanceTexture texture(picture);
  const auto towards = [&](double x, double y, double z) {
    Hit hit;
    hit.position = (picture.center + 2.0 * Vector3(x, y, z).normalized()).cast<float>();
    return hit;
  };
  const double high = std::tan(0.25 * 3.14159265358979);
  // The middle column is at +z, the right one a third of the way round towards +x; rows at 45 degrees.
  expectPixel(texture, towards(0, high, 1), pixelOf(1, 0, 0), pixelOf(1, 0, 1), "front, above");
  expectPixel(texture, towards(0, -high, 1), pixelOf(1, 1, 0), pixelOf(1, 1, 1), "front, below");
  expectPixel(texture, towards(std::sqrt(0.75), high, -0.5), pixelOf(2, 0, 0), pixelOf(2, 0, 1), "right");
  expectPixel(texture, towards(-std::sqrt(0.75), high, -0.5), pixelOf(0, 0, 0), pixelOf(0, 0, 1), "left");
  expectPixel(texture, towards(0, high, -1), (pixelOf(0, 0, 0) + pixelOf(2, 0, 0)) / 2,
              (pixelOf(0, 0, 1) + pixelOf(2, 0, 1)) / 2, "behind, over the seam");
}

TEST(ReflectanceTextureTest, RepeatsOnAMeshByItsCorners) {
  Texture picture = sixPixels(Texture::Wrap::Mesh);
  picture.corners = {{{{0, 0}, {1, 0}, {0, 1}}}, {{{2, 0}, {2, 3}, {-1, 0}}}};
  const ReflectanceTexture texture(picture);
  expectPixel(texture, hitAt(0.5 / 3, 0.75), pixelOf(0, 0, 0), pixelOf(0, 0, 1), "as a rectangle");
  Hit hit = hitAt(0, 0);
  hit.u = 0.25F;  // (2, 0.75)
  hit.primitive = 1;
  expectPixel(texture, hit, (pixelOf(0, 0, 0) + pixelOf(2, 0, 0)) / 2, (pixelOf(0, 0, 1) + pixelOf(2, 0, 1)) / 2,
              "over the edge");
}

/// A wall that fills the view, in even light: what its pixels send is their reflectance.
std::string wallOf(const std::string& diffuse, int maxDepth = 2) {
  return "metamer_scene: 1\n"
         "film: {width: 16, height: 16, bins: {from: 380, to: 780, step: 50}}\n"
         "camera: {origin: [0, 0, 4], target: [0, 0, 0], fov_x: 28.0724869}\n"
         "integrator: {max_depth: " +
         std::to_string(maxDepth) +
         ", wavelengths: 4}\n"
         "lights: [{environment: {emission: 1}}]\n"
         "shapes:\n"
         "  - rectangle: {center: [0, 0, 0], half_u: [1, 0, 0], half_v: [0, 1, 0]}\n"
         "    diffuse: " +
         diffuse + "\n";
}

std::string pictureAt(const std::filesystem::path& file, const std::string& more = "") {
  return "{picture: " + file.string() + more + "}";
}

/// Reflectances that rise from 0.2 to 0.5 and fall from 0.8 to 0.3, side by side.
std::filesystem::path twoSpectra() {
  return exrFile("texture_spectra", 2, 1, 3, {0.2F, 0.35F, 0.5F, 0.8F, 0.55F, 0.3F},
                 {"T.380,000000nm", "T.580,000000nm", "T.780,000000nm"});
}

TEST(ReflectanceTextureTest, IsRenderedWithTheSpectraOfAPicture) {
  const Scene scene = sceneOf(wallOf(pictureAt(twoSpectra())));
  EXPECT_TRUE(scene.warnings.empty());
  const Film film = rendered(scene, 512);
  const Film white = rendered(sceneOf(wallOf("1")), 512);
  for (int bin = 1; bin + 1 < film.format().bins.count; ++bin) {
    const double along = (film.format().bins.centreNm(bin) - 380) / 400;
    const double rises = 0.2 + 0.3 * along;
    const double falls = 0.8 - 0.5 * along;
    // The picture is as much the one as the other.
    EXPECT_NEAR(meanRadiance(film, bin) / meanRadiance(white, bin), (rises + falls) / 2, 2e-3)
        << film.format().bins.centreNm(bin);
  }
  const AreaMean left = luminanceOver(film, 0, 0, 4, 16);
  const AreaMean right = luminanceOver(film, 12, 0, 4, 16);
  const double level = luminanceOver(white, 0, 0, 16, 16).mean;
  const auto curves = testLibrary().observer("CIE 1931 2").onDomain();
  double rises = 0;
  double falls = 0;
  for (int k = 0; k < spectral::kDomainSize; ++k) {
    const double weight = curves(k, 1) / curves.col(1).sum();
    rises += weight * (0.2 + 0.3 * k / 400.0);
    falls += weight * (0.8 - 0.5 * k / 400.0);
  }
  EXPECT_NEAR(left.mean / level, rises, 4 * left.error / level + 1e-3);
  EXPECT_NEAR(right.mean / level, falls, 4 * right.error / level + 1e-3);
}

TEST(ReflectanceTextureTest, IsFoundByEveryTechnique) {
  const Scene scene = sceneOf(wallOf(pictureAt(twoSpectra()), 4));
  const AreaMean plain = luminanceOver(rendered(scene, 256), 0, 0, 16, 16);
  RenderOptions options;
  options.restir = Restir::Lanes;
  const AreaMean resampled = luminanceOver(rendered(scene, 256, options), 0, 0, 16, 16);
  EXPECT_NEAR(resampled.mean, plain.mean, 4 * std::hypot(plain.error, resampled.error));
  EXPECT_EQ(luminanceOver(rendered(scene, 16, {}, 1), 0, 0, 16, 16).mean,
            luminanceOver(rendered(scene, 16, {}, 2), 0, 0, 16, 16).mean);
}

/// The spectrum at the picture's left.
spectral::DomainSamples leftOf(const Scene& scene) {
  const ReflectanceTexture texture(scene.textures.at(0));
  spectral::DomainSamples samples;
  for (int cell = 0; cell < kCells; ++cell) {
    WavelengthSet<1> set{};
    set.cell = {cell};
    samples[cell] = texture.at<1>(hitAt(0, 0.5), set)[0];
  }
  return samples;
}

TEST(ReflectanceTextureTest, ColoursAreUpliftedByAnyMethod) {
  const std::vector<double> colour = {0.45, 0.27, 0.19};
  const auto file = exrFile("texture_colours", 2, 1, 3, {0.45F, 0.27F, 0.19F, 0.1F, 0.2F, 0.3F});
  const auto curves = testLibrary().observer("CIE 1931 2").onDomain();
  const auto light = testLibrary().illuminant("D65").onDomain();
  const auto labOf = [&](const spectral::DomainSamples& samples) {
    const Eigen::Vector3d xyz = curves.transpose() * samples.cwiseProduct(light);
    const Eigen::Vector3d white = curves.transpose() * light;
    return spectral::lab(xyz / white.y(), white / white.y());
  };
  for (const std::string& method : sip::upliftNames()) {
    const spectral::DomainSamples found = leftOf(sceneOf(wallOf(pictureAt(file, ", uplift: " + method))));
    const auto uplift = sip::makeUplift(method, testLibrary());
    std::vector<double> values(uplift->wavelengthsNm().size());
    uplift->spectra(colour, values);
    const spectral::DomainSamples wanted =
        spectral::Spectrum(method, spectral::SpectralQuantity::Reflectance, uplift->wavelengthsNm(), values).onDomain();
    const double difference = spectral::deltaE2000(labOf(found), labOf(wanted));
    std::printf("[ texture ] %-12s rms %.4f, CIEDE2000 under D65 %.3f\n", method.c_str(),
                std::sqrt((found - wanted).squaredNorm() / spectral::kDomainSize), difference);
    EXPECT_LE(difference, 0.02) << method;
  }
}

TEST(ReflectanceTextureTest, BytesCarryTheCurveOfSrgbAndSpacesTheirPrimaries) {
  // Code 118 is 0.18 of light.
  const auto grey = pngFile("texture_grey", 1, 1, 3, {118, 118, 118});
  EXPECT_NEAR(leftOf(sceneOf(wallOf(pictureAt(grey))))[200], 0.181, 1e-3);
  const auto one = pngFile("texture_one", 1, 1, 1, {118});
  EXPECT_NEAR(leftOf(sceneOf(wallOf(pictureAt(one))))[200], 0.181, 1e-3);
  // The same numbers are another colour in a wider space.
  const auto file = exrFile("texture_space", 1, 1, 3, {0.4F, 0.3F, 0.2F});
  const auto wide = leftOf(sceneOf(wallOf(pictureAt(file, ", space: ACEScg"))));
  const auto narrow = leftOf(sceneOf(wallOf(pictureAt(file))));
  EXPECT_GT((wide - narrow).cwiseAbs().maxCoeff(), 0.02);
}

TEST(ReflectanceTextureTest, WhatNoSurfaceHasIsCutAndSaid) {
  const auto bright = exrFile("texture_bright", 2, 1, 3, {1.5F, 1.5F, 1.5F, 0.2F, 0.2F, 0.2F});
  const Scene scene = sceneOf(wallOf(pictureAt(bright)));
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_NE(scene.warnings[0].find("50 % of the pixels"), std::string::npos) << scene.warnings[0];
  EXPECT_EQ(leftOf(scene).maxCoeff(), 1.0);
}

TEST(ReflectanceTextureTest, RefusesWhatItCannotUse) {
  EXPECT_REFUSED("uplift", sceneOf(wallOf(pictureAt(twoSpectra(), ", uplift: jakob"))));
  EXPECT_REFUSED("space", sceneOf(wallOf(pictureAt(twoSpectra(), ", space: ACEScg"))));
  const auto file = exrFile("texture_refused", 1, 1, 3, {0.1F, 0.1F, 0.1F});
  EXPECT_REFUSED("must be one of", sceneOf(wallOf(pictureAt(file, ", uplift: magic"))));
  EXPECT_REFUSED("space", sceneOf(wallOf(pictureAt(file, ", space: magic"))));
  EXPECT_REFUSED("numbers", sceneOf(wallOf(pictureAt(file, ", numbers: 41"))));
  EXPECT_REFUSED("texture.png", sceneOf(wallOf("{picture: texture.png}")));
  EXPECT_REFUSED("picture", sceneOf(wallOf("{uplift: jakob}")));

  const std::filesystem::path mesh = scratchFile("texture_none.obj");
  std::ofstream(mesh) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const auto of = [&](const std::filesystem::path& shape) {
    return "metamer_scene: 1\nshapes:\n  - mesh: " + shape.string() + "\n    diffuse: " + pictureAt(file) + "\n";
  };
  EXPECT_REFUSED("no texture coordinates", sceneOf(of(mesh)));
  const std::filesystem::path far = scratchFile("texture_far.obj");
  std::ofstream(far) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1e9 0\nvt 0 1\nf 1/1 2/2 3/3\n";
  EXPECT_REFUSED("no texture coordinates", sceneOf(of(far)));
}

TEST(ReflectanceTextureTest, AMeshHasItFromItsFile) {
  const std::filesystem::path mesh = scratchFile("texture_mesh.obj");
  std::ofstream(mesh) << "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                         "f 1/1 2/2 3/3 4/4\n";
  const std::string wall = wallOf(pictureAt(twoSpectra()));
  std::string plate = wall;
  const std::string rectangle = "rectangle: {center: [0, 0, 0], half_u: [1, 0, 0], half_v: [0, 1, 0]}";
  plate.replace(plate.find(rectangle), rectangle.size(), "mesh: " + mesh.string());
  const Film one = rendered(sceneOf(wall), 64);
  const Film other = rendered(sceneOf(plate), 64);
  // The middle: a mesh repeats at its edges, where a rectangle ends.
  for (const int x : {5, 8}) {
    const AreaMean a = luminanceOver(one, x, 2, 3, 12);
    const AreaMean b = luminanceOver(other, x, 2, 3, 12);
    EXPECT_NEAR(a.mean, b.mean, 4 * std::hypot(a.error, b.error) + 1e-4 * a.mean) << x;
  }
}

}  // namespace
}  // namespace metamer::spectral_ref
