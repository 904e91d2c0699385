// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral_ref/scene_reader.h"

#include <gtest/gtest.h>

#include "metamer/spectral/uplift.h"
#include "spectral/temporary_folder.h"
#include "spectral_ref/scene_fixture.h"

namespace metamer::spectral_ref {
namespace {

std::string errorIn(const std::string& text) {
  return spectral::errorOf([&] { sceneOf("metamer_scene: 1\n" + text); });
}

TEST(SceneReaderTest, ReadsTheWholeExample) {
  const Scene scene = sceneOf(
      "metamer_scene: 1\n"
      "film: {width: 256, height: 128, observer: CIE 1931 2, space: XYZ, bins: {from: 380, to: 780, step: 10}}\n"
      "camera: {origin: [0, 0, 9], target: [0, 0, 0], up: [0, 1, 0], fov_x: 40}\n"
      "integrator: {max_depth: 6, russian_roulette: 5, wavelengths: 8}\n"
      "spectra: {lamp: {illuminant: A, scale: 12}, paint: {wavelengths: [400, 700], values: [0.2, 0.6]}}\n"
      "shapes:\n"
      "  - rectangle: {center: [0, 0, 0], half_u: [1, 0, 0], half_v: [0, 1, 0]}\n"
      "    diffuse: paint\n"
      "  - rectangle: {center: [-3, 4, 6], half_u: [1, 0, 0], half_v: [0, 0, 1]}\n"
      "    emission: lamp\n");
  EXPECT_EQ(scene.film.width, 256);
  EXPECT_EQ(scene.film.bins.count, 41);
  EXPECT_EQ(scene.integrator.wavelengths, 8);
  ASSERT_EQ(scene.rectangles.size(), 2U);
  const auto& paint = scene.spectra[scene.materials[scene.rectangles[0].surface.material].colour];
  EXPECT_DOUBLE_EQ(paint[0], 0.2);    // a reflectance holds its end values
  EXPECT_DOUBLE_EQ(paint[170], 0.4);  // 550 nm
  const auto& lamp = scene.spectra[scene.rectangles[1].surface.emission->spectrum];
  EXPECT_DOUBLE_EQ(lamp[180], 1200.0);  // 12 times the table, which is 100 at 560 nm
}

TEST(SceneReaderTest, AnInlineEmissionIsZeroOutsideItsTable) {
  const Scene scene = sceneOf(
      "metamer_scene: 1\n"
      "spectra: {line: {wavelengths: [588, 589, 590], values: [0, 4, 0]}}\n"
      "lights: [{environment: {emission: line}}]\n");
  EXPECT_DOUBLE_EQ(scene.spectra.front().sum(), 4.0);
}

TEST(SceneReaderTest, ColoursBecomeReflectancesByAnyUplift) {
  const std::vector<double> colour = {0.45, 0.27, 0.19};
  for (const std::string& method : spectral::upliftMethodNames()) {
    if (method == "jakob table") {
      continue;  // built for seconds, and jakob's within 0.2
    }
    const Scene scene = sceneOf("metamer_scene: 1\nspectra: {paint: {rgb: [0.45, 0.27, 0.19], uplift: " + method +
                                "}}\nshapes: [{sphere: {center: [0, 0, 0], radius: 1}, diffuse: paint}]\n");
    const auto uplift = spectral::makeUplift(spectral::upliftMethodNamed(method), spectral::testLibrary());
    std::vector<double> values(uplift->wavelengthsNm().size());
    uplift->spectra(colour, values);
    const spectral::Spectrum wanted("paint", spectral::SpectralQuantity::Reflectance, uplift->wavelengthsNm(), values);
    EXPECT_LT((scene.spectra.front() - wanted.onDomain()).cwiseAbs().maxCoeff(), 1e-12) << method;
  }
  // Left out, it is jakob's.
  const auto paint = [](const std::string& method) {
    return sceneOf("metamer_scene: 1\nspectra: {paint: {rgb: [0.45, 0.27, 0.19]" + method +
                   "}}\nshapes: [{sphere: {center: [0, 0, 0], radius: 1}, diffuse: paint}]\n");
  };
  EXPECT_EQ(paint("").spectra.front(), paint(", uplift: jakob").spectra.front());
}

TEST(SceneReaderTest, FluorescentSurfacesAreReadFromCurvesAndFiles) {
  const std::string curves =
      "metamer_scene: 1\n"
      "spectra: {taken: {wavelengths: [320, 400, 480], values: [0, 0.6, 0]}, given: {wavelengths: [450, 520, 600], "
      "values: "
      "[0, 2, 0]}, wall: {wavelengths: [300, 400], values: [0.1, 0.3]}}\n"
      "shapes: [{sphere: {center: [0, 0, 0], radius: 1}, fluorescent: ";
  const Scene scene =
      sceneOf(curves + "{reflectance: 0.3, excitation: taken, emission: given, quantum_yield: 0.5}}]\n");
  const Material& material = scene.materials[scene.spheres[0].surface.material];
  ASSERT_EQ(material.kind, Material::Kind::Fluorescent);
  const spectral::FluorescentSamples& surface = scene.fluorescences[material.fluorescence];
  EXPECT_NEAR(surface.mostPhotons(), 0.3 + 0.5 * 0.6, 1e-9);
  // 150 nm wide at half of a height of 2: what they integrate to counts as 1.
  EXPECT_NEAR(surface.perNm(520 - 300, 400 - 300), 0.5 * 0.6 * 2.0 / 150.0 * 400 / 520, 1e-9);
  EXPECT_EQ(scene.spectra[material.colour][0], 0.3);

  // The same from a file; and below 380 nm a surface is as its table says.
  const TemporaryFolder folder;
  std::ofstream(folder / "dye.csv") << "quantum_yield,0.5\nwavelength_nm,reflectance,excitation,emission\n320,0.3,0,0\n"
                                       "400,0.3,0.6,0\n450,0.3,0.225,0\n480,0.3,0,0.857142857142857\n520,0.3,0,2\n"
                                       "600,0.3,0,0\n";
  const Scene ofFile =
      parseScene(curves + "{file: dye.csv}}, {sphere: {center: [0, 0, 0], radius: 1}, diffuse: wall}]\n", "scene.yaml",
                 folder.path(), spectral::testLibrary());
  EXPECT_LT((ofFile.fluorescences.at(0).perNm - surface.perNm).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_NEAR(ofFile.ultraviolet.back()[20], 0.14, 1e-12);
  EXPECT_NE(ofFile.fingerprint, scene.fingerprint);

  const auto refused = [&](const std::string& given) { return errorIn(curves.substr(17) + given + "}]\n"); };
  EXPECT_NE(refused("{reflectance: 0.5, excitation: taken, emission: given, quantum_yield: 0.5}").find("together"),
            std::string::npos);
  EXPECT_NE(refused("{reflectance: 0.3, excitation: taken, emission: given}").find("quantum_yield"), std::string::npos);
  EXPECT_NE(refused("{reflectance: 0.3, excitation: taken, emission: given, quantum_yield: 1.2}").find("0 to 1"),
            std::string::npos);
  EXPECT_NE(refused("{file: dye.csv, quantum_yield: 1}").find("stands in the file"), std::string::npos);
  EXPECT_NE(refused("{file: none.csv}").find("no such file"), std::string::npos);
}

TEST(SceneReaderTest, CamerasAndSpaces) {
  EXPECT_EQ(sceneOf("metamer_scene: 1\nfilm: {observer: Nikon D5100, space: native}\n").film.space, "native");
  EXPECT_NE(errorIn("film: {observer: Nikon D5100, space: ACEScg}").find("space: native"), std::string::npos);
  EXPECT_EQ(sceneOf("metamer_scene: 1\nfilm: {space: ACEScg}\n").film.space, "ACEScg");
  EXPECT_NE(errorIn("film: {space: ACEScct}").find("is encoded"), std::string::npos);
}

TEST(SceneReaderTest, EveryComplaintNamesItsPlaceAndRemedy) {
  const struct {
    const char* text;
    const char* expected;
  } cases[] = {
      {"film: {width: 0}", "scene.yaml:2:15: film.width '0': must be a whole number from 1 to 65536"},
      {"film: {width: 1.5}", "whole number"},
      {"film: {width: 12x}", "whole number"},
      {"film: {hieght: 3}", "scene.yaml:2:8: key 'film.hieght': unknown; did you mean 'height'?"},
      {"film: {width: 2, width: 3}", "twice"},
      {"film: [", "scene.yaml:2:1: YAML"},
      {"film: {bins: {from: 380, to: 780}}", "film.bins.step: is missing"},
      {"film: {bins: {from: 380, to: 775, step: 10}}", "whole number of steps"},
      {"film: {observer: CIE 1931 3}", "CIE 1931 2"},
      {"camera: {origin: [0, 0, 0], target: [0, 0, 0]}", "the same point"},
      {"camera: {origin: [0, 0, 1], up: [0, 0, 2]}", "along the view"},
      {"camera: {origin: [0, .nan, 1]}", "must be a number"},
      {"camera: {origin: [0, 1]}", "three numbers"},
      {"integrator: {wavelengths: 3}", "must be 1, 4, 8 or 16"},
      {"integrator: {max_depth: 0}", "from 1 to"},
      {"shapes: [{diffuse: 1}]", "must be one"},
      {"shapes: [{rectangle: {center: [0, 0, 0], half_u: [1, 0, 0], half_v: [0, 1, 0]}}]", "has no material"},
      {"shapes: [{rectangle: {center: [0, 0, 0], half_u: [1, 0, 0], half_v: [2, 0, 0]}, diffuse: 1}]", "has no area"},
      {"shapes: [{rectangle: {center: [0, 0, 0], half_u: [1, 0, 0]}, diffuse: 1}]", "half_v: is missing"},
      {"shapes: [{sphere: {center: [0, 0, 0], radius: -1}, diffuse: 1}]", "radius"},
      {"shapes: [{sphere: {center: [0, 0, 0], radius: 1}, diffuse: 1.5}]", "above 1"},
      {"shapes: [{sphere: {center: [0, 0, 0], radius: 1}, diffuse: pant}]\nspectra: {paint: {constant: 1}}",
       "did you mean 'paint'?"},
      {"shapes: [{sphere: {center: [0, 0, 0], radius: 1}, diffuse: a}]\nspectra: {a: {illuminant: A}}",
       "is an illuminant"},
      {"shapes: [{sphere: {center: [0, 0, 0], radius: 1}, diffuse: a}]\nspectra: {a: {rgb: [0.1, 0.2]}}",
       "three numbers from 0 to 1"},
      {"shapes: [{sphere: {center: [0, 0, 0], radius: 1}, diffuse: a}]\nspectra: {a: {rgb: [0.1, 0.2, 1.2]}}", "1.2"},
      {"shapes: [{sphere: {center: [0, 0, 0], radius: 1}, diffuse: a}]\n"
       "spectra: {a: {rgb: [0.1, 0.2, 0.3], uplift: jakub}}",
       "smits, mallett, jakob"},
      {"shapes: [{sphere: {center: [0, 0, 0], radius: 1}, emission: a}]\nspectra: {a: {rgb: [0.1, 0.2, 0.3]}}",
       "is the colour of a surface"},
      {"shapes: [{sphere: {center: [0, 0, 0], radius: 1}, emission: FL111}]", "FL11"},
      {"shapes: [{sphere: {center: [0, 0, 0], radius: 1}, emission: a}]\nspectra: {a: {constant: 1, filter: x}}",
       "must have one of"},
      {"shapes: [{sphere: {center: [0, 0, 0], radius: 1}, emission: a}]\n"
       "spectra: {a: {wavelengths: [500, 400], values: [1, 1]}}",
       "above the one before"},
      {"shapes: [{sphere: {center: [0, 0, 0], radius: 1}, emission: a}]\n"
       "spectra: {a: {wavelengths: [400, 500], values: [1, -1]}}",
       "negative"},
      {"shapes: [{sphere: {center: [0, 0, 0], radius: 1}, dielectric: {index: 9}}]", "from 1 to 4"},
      {"shapes: [{sphere: {center: [0, 0, 0], radius: 1}, dielectric: {index: {cauchy: [0.5]}}}]", "between 1 and 4"},
      {"shapes: [{sphere: {center: [0, 0, 0], radius: 1}, conductor: {reflectance: 1}}]", "roughness"},
      {"lights: [{environment: {emission: 1}}, {environment: {emission: 1}}]", "second one"},
      {"lights: [{spot: {position: [0, 0, 0], target: [0, 0, 0], intensity: 1}}]", "own position"},
      {"metamer_scene: 1", "twice"},
  };
  for (const auto& [text, expected] : cases) {
    const std::string message = errorIn(text);
    EXPECT_NE(message.find(expected), std::string::npos) << text << "\n  " << message;
    EXPECT_EQ(message.rfind("scene.yaml", 0), 0U) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
  EXPECT_NE(spectral::errorOf([] { sceneOf(""); }).find("is empty"), std::string::npos);
  EXPECT_NE(spectral::errorOf([] { sceneOf("film: {}"); }).find("metamer_scene: is missing"), std::string::npos);
  EXPECT_NE(spectral::errorOf([] { sceneOf("metamer_scene: 2"); }).find("does not read"), std::string::npos);
  EXPECT_NE(spectral::errorOf([] { sceneOf("a: 1\n---\nb: 1"); }).find("more than one document"), std::string::npos);
  // yaml-cpp's LoadAll never comes to the end of this one.
  EXPECT_NE(spectral::errorOf([] { sceneOf(", x"); }).find("scene.yaml"), std::string::npos);
  EXPECT_NE(spectral::errorOf([] { sceneOf(std::string(5000, '[')); }).find("scene.yaml"), std::string::npos);
}

}  // namespace
}  // namespace metamer::spectral_ref
