// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/shader_bake.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <fstream>

#include "files/shader_text.h"
#include "ocio_plugin/bake/look_recipe.h"
#include "sip/device/device_fixture.h"
#include "sip/device/opencl_device.h"
#include "spectral/fixture.h"
#include "spectral/temporary_folder.h"

namespace metamer::ocio {
namespace {

using spectral::errorOf;
using spectral::testLibrary;

const ShaderFormat& formatNamed(const std::string& name) {
  return *findShaderFormat({}, name);
}

/// One file for the tests that read it.
const BakedText& sodium() {
  static const BakedText baked = bakeShaderText(recipeOf("D65", "HP1"), testLibrary(), formatNamed("opencl"));
  return baked;
}

std::vector<float> throughMap(std::vector<float> pixels) {
  static const sip::HomogeneousMap map = sip::buildHomogeneousMap(sip::SpectralTransform(
      sip::resolve(recipeOf("D65", "HP1"), testLibrary(), testLibrary().colourSpace("ACEScg").linear),
      sodium().certificate.bandCount));
  map.apply(pixels);
  return pixels;
}

TEST(ShaderBakeTest, TheFileHoldsTheMapToTheBit) {
  const std::vector<float> pixels = sip::pixelsOfEveryKind(20'000, 5);
  std::vector<float> given = pixels;
  sip::applyDeviceKernel(sip::DeviceKernel::Map, shaderTables(sodium().text), given);
  std::string first;
  EXPECT_EQ(sip::differingBits(throughMap(pixels), given, first), 0U) << first;
}

TEST(ShaderBakeTest, TheWholeFileRunsAsOpenCl) {
  std::string reason;
  const auto device = sip::OpenClDevice::find(reason);
  if (!device) {
    GTEST_SKIP() << reason << ": the OpenCL file is not run; install pocl-opencl-icd";
  }
  const std::vector<float> pixels = sip::pixelsOfEveryKind(20'000, 6);
  const std::vector<float> given = device->run(sodium().text, "metamerMapPixels", shaderTables(sodium().text), pixels);
  std::string first;
  EXPECT_EQ(sip::differingBits(throughMap(pixels), given, first), 0U) << first;
}

TEST(ShaderBakeTest, EveryLanguageHoldsTheSameTables) {
  const sip::DeviceTables tables = shaderTables(sodium().text);
  const TemporaryFolder folder;
  for (const ShaderFormat& format : shaderFormats()) {
    if (!format.dialect) {
      continue;
    }
    const std::string text = shaderText(*format.dialect, tables, {"look", "id", {"a line"}});
    const sip::DeviceTables again = shaderTables(text);
    EXPECT_TRUE(again.cells == tables.cells) << format.name;
    EXPECT_EQ(std::memcmp(again.nodes.data(), tables.nodes.data(), sizeof(tables.nodes[0]) * tables.nodes.size()), 0);
    EXPECT_NE(text.find("metamerMap("), std::string::npos) << format.name;
    std::ofstream(folder / ("file" + format.extension)) << text;
  }
  if (std::system("command -v glslangValidator > /dev/null") != 0) {
    GTEST_SKIP() << "no glslangValidator: the GLSL and HLSL files are not looked at; install glslang-tools";
  }
  const std::string file = folder / "file";
  EXPECT_EQ(
      std::system(("glslangValidator -G --target-env opengl -S comp -o " + file + ".spv " + file + ".glsl > /dev/null")
                      .c_str()),
      0);
  EXPECT_EQ(std::system(
                ("glslangValidator -D -V -S comp -e metamerMapPixels -o " + file + ".spv " + file + ".hlsl > /dev/null")
                    .c_str()),
            0);
}

TEST(ShaderBakeTest, CommentsCannotBeLeft) {
  const std::string text = shaderText(sip::DeviceDialect::Glsl, {{{1, 2, 3, 4}}, {5}},
                                      {"a\n#error\n*/ \\", "id", {"\\", "\xC3\xA9 #error\n#error"}});
  EXPECT_EQ(text.find("\n#error"), std::string::npos);
  EXPECT_EQ(text.substr(0, text.find("#version")).find('\\'), std::string::npos);
}

TEST(ShaderBakeTest, TheCertificateIsTheMaps) {
  const Certificate& certificate = sodium().certificate;
  EXPECT_EQ(certificate.representation, Representation::HomogeneousMap);
  EXPECT_EQ(certificate.format, "opencl");
  EXPECT_EQ(certificate.sha256, sha256(sodium().text));
  EXPECT_EQ(certificate.probes.lowestStop, -10);
  // A tenth for the map, a few hundredths for 161 bands in place of 401.
  EXPECT_LE(certificate.error.p99, 0.25);
  EXPECT_GT(certificate.error.count, 10'000U);
  EXPECT_NE(certificate.json().find("\"representation\": \"homogeneous map\""), std::string::npos);
  EXPECT_NE(sodium().text.find("homogeneous map"), std::string::npos);
}

/// The probes of a certificate are some 24,000 colours over the gamut, of twenty exposures, and those that its search
/// adds.
TEST(ShaderBakeTest, DctlIsWithinAQuarter) {
  for (const auto& [light, adaptation] : {std::pair{"HP1", 0.0}, {"A", 0.5}, {"LED-RGB1", 1.0}}) {
    sip::Recipe recipe = recipeOf("D65", light);
    recipe.scene = {};
    recipe.adaptation = adaptation;
    const BakedText baked = bakeShaderText(recipe, testLibrary(), formatNamed("dctl"));
    EXPECT_LE(baked.certificate.error.p99, 0.25) << light;
    EXPECT_LE(baked.certificate.error.max, 2.0) << light;
    EXPECT_EQ(baked.certificate.size, 513);
    EXPECT_NE(baked.text.find("DEFINE_CUBE_LUT(metamerTable)\n{\nLUT_3D_SIZE 65\n"), std::string::npos);
  }
  const BakedText same = bakeShaderText(recipeOf("D65", "D65"), testLibrary(), formatNamed("dctl"));
  EXPECT_LE(same.certificate.error.max, 1e-3);
}

TEST(ShaderBakeTest, AnIdentityStaysOne) {
  const BakedText baked = bakeShaderText(recipeOf("D65", "D65"), testLibrary(), formatNamed("metal"));
  EXPECT_EQ(baked.certificate.representation, Representation::Identity);
  std::vector<float> pixels = {0.1F, -2.0F, 3e5F, 0.5F};
  sip::applyDeviceKernel(sip::DeviceKernel::Map, shaderTables(baked.text), pixels);
  EXPECT_EQ(pixels, (std::vector{0.1F, -2.0F, 3e5F, 0.5F}));
}

TEST(ShaderBakeTest, WhatCannotBeBakedLeavesNothingBehind) {
  const TemporaryFolder folder;
  const auto error = [&](const BakeOptions& options, const std::string& space = "ACEScg") {
    return errorOf([&] {
      bakeShaderFile(recipeOf("D65", "A", space), testLibrary(), folder / "a.glsl", formatNamed("glsl"), options);
    });
  };
  EXPECT_NE(error({.size = 33}).find("size '33'"), std::string::npos) << error({.size = 33});
  EXPECT_NE(error({.fitted = false}).find("sampled"), std::string::npos);
  EXPECT_NE(error({.shaper = spectral::LogEncoding::LogC3}).find("linear pixels of any exposure"), std::string::npos);
  EXPECT_NE(error({.shaperSize = 64}).find("no curve"), std::string::npos);
  EXPECT_NE(error({.representation = Representation::Matrix}).find("homogeneous map"), std::string::npos);
  EXPECT_NE(error({}, "ACEScct").find("lutgen list spaces"), std::string::npos);
  EXPECT_NE(error({.tolerance = 0.001}).find("allow more"), std::string::npos);
  EXPECT_NE(error({.lowestStop = 3, .highestStop = 2}).find("must rise"), std::string::npos);
  EXPECT_TRUE(folder.isEmpty());
  EXPECT_NE(errorOf([] { findShaderFormat("a.cl", "metal"); }).find("*.metal"), std::string::npos);
  EXPECT_EQ(findShaderFormat("a.cube", ""), nullptr);
  EXPECT_EQ(findShaderFormat("a.CL", "")->name, "opencl");
}

TEST(ShaderBakeTest, CutTablesAreRefused) {
  const std::string& text = sodium().text;
  EXPECT_NE(errorOf([] { shaderTables("kernel"); }).find("are not in the text"), std::string::npos);
  EXPECT_NE(errorOf([&] { shaderTables(text.substr(0, text.size() / 2)); }).find("cut short"), std::string::npos);
  EXPECT_NE(errorOf([] { shaderTables("/* metamer tables: 99999999999 nodes, 1 cells\n*/"); }).find("how many"),
            std::string::npos);
}

}  // namespace
}  // namespace metamer::ocio
