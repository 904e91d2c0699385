// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/bake.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "metamer/ocio/pixel_processor.h"
#include "ocio_plugin/bake/look_recipe.h"
#include "sip/sip_fixture.h"
#include "spectral/temporary_folder.h"

namespace metamer::ocio {
namespace {

using spectral::errorOf;
using spectral::testLibrary;

TEST(BakeTest, AnIdentityIsANoOp) {
  const Baked baked = bake(recipeOf("D65", "D65"), testLibrary());
  EXPECT_EQ(baked.certificate.representation, Representation::Identity);
  EXPECT_TRUE(OCIO::Config::CreateRaw()->getProcessor(baked.group)->isNoOp());
  // The probes are floats, the expected colours are not.
  EXPECT_LE(baked.certificate.error.max, 1e-4);
}

TEST(BakeTest, AnIdentityFileIsANoOp) {
  const TemporaryFolder folder;
  for (const char* name : {"a.ctf", "a.clf"}) {
    for (const char* space : {"ACEScg", "ACEScct"}) {
      const Certificate certificate = bakeFile(recipeOf("D65", "D65", space), testLibrary(), folder / name);
      EXPECT_EQ(certificate.representation, Representation::Identity);
      EXPECT_TRUE(PixelProcessor::fromFile(folder / name).isNoOp()) << name << " " << space;
    }
  }
  // A cube of 0 ... 1 clips, so it is an identity there alone.
  bakeFile(recipeOf("D65", "D65"), testLibrary(), folder / "a.cube");
  std::array<float, 4> pixel = {0.1F, 0.55F, 0.93F, 1.0F};
  PixelProcessor::fromFile(folder / "a.cube").apply(pixel);
  EXPECT_NEAR(pixel[0], 0.1F, 1e-6);
  EXPECT_NEAR(pixel[1], 0.55F, 1e-6);
}

TEST(BakeTest, TheDoorGivesTheChainAndItsError) {
  sip::Recipe recipe = recipeOf("D65", "FL11");
  recipe.scene = {};
  const Baked baked = bake(recipe, testLibrary());
  EXPECT_EQ(baked.certificate.representation, Representation::ExposureInvariantChain);
  EXPECT_EQ(baked.certificate.size, 65);
  EXPECT_GT(baked.certificate.error.p99, 0.0);
  EXPECT_LE(baked.certificate.error.p99, 1.0);
  EXPECT_TRUE(baked.certificate.sha256.empty());
}

TEST(BakeTest, TheMatrixSaysHowFarItIsOff) {
  BakeOptions options;
  options.representation = Representation::Matrix;
  const Baked baked = bake(recipeOf("D65", "HP1"), testLibrary(), options);
  EXPECT_EQ(baked.group->getNumTransforms(), 1);
  EXPECT_GT(baked.certificate.error.p99, 5.0);
}

// A 33-node cube in the middle of its range; the dark toe, where a cell spans several stops, is left to finer tables.
TEST(BakeTest, CubesOfLinearAndLogSpacesAgree) {
  const TemporaryFolder folder;
  bakeFile(recipeOf("D65", "A"), testLibrary(), folder / "linear.cube");
  const Certificate log = bakeFile(recipeOf("D65", "A", "ACEScct"), testLibrary(), folder / "log.cube");
  EXPECT_EQ(log.shaper, "ACEScct");
  std::vector<float> a = {0.41F, 0.45F, 0.5F, 1.0F, 0.6F, 0.3F, 0.35F, 1.0F};
  std::vector<float> b = a;
  PixelProcessor::fromFile(folder / "linear.cube").apply(a);
  PixelProcessor::fromFile(folder / "log.cube").apply(b);
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_NEAR(a[k], b[k], 1e-6);
  }
  EXPECT_GT(std::abs(a[0] - 0.41F), 0.01F);
}

TEST(BakeTest, ShaperCurvesStandWhereTheyHelp) {
  const auto entriesOf = [](const char* format, const BakeOptions& options) {
    return bakeText(recipeOf("D65", "A"), testLibrary(), format, options).certificate.shaperEntries;
  };
  EXPECT_NE(bakeText(recipeOf("D65", "A"), testLibrary(), "resolve_cube", {.size = 17}).text.find("LUT_1D_SIZE 4096"),
            std::string::npos);
  EXPECT_EQ(entriesOf("clf", {.size = 17}), 4096);
  for (const char* name : {"resolve_cube", "cinespace", "houdini"}) {
    EXPECT_EQ(entriesOf(name, {.size = 17}), 4096) << name;
  }
  EXPECT_EQ(entriesOf("clf", {.size = 17, .shaperSize = 300}), 300);
  EXPECT_EQ(entriesOf("clf", {.size = 16}), 0) << "few nodes";
  EXPECT_EQ(entriesOf("clf", {.size = 17, .fitted = false}), 0) << "the classical table";
  EXPECT_EQ(entriesOf("iridas_cube", {.size = 17}), 0) << "no place for one";
  EXPECT_EQ(entriesOf("ctf", {.size = 17}), 0) << "no cube";
  EXPECT_EQ(entriesOf("ctf", {.representation = Representation::LogCube, .size = 17}), 4096);
}

// Sampled nodes are the engine's own answers: light in, through the curve, light out.
TEST(BakeTest, SampledCubeNodesAreExact) {
  const TemporaryFolder folder;
  BakeOptions options;
  options.fitted = false;
  bakeFile(recipeOf("D65", "HP1"), testLibrary(), folder / "a.cube", {}, options);
  const auto processor = PixelProcessor::fromFile(folder / "a.cube");
  const sip::SpectralTransform engine(sip::resolve(recipeOf("D65", "HP1"), testLibrary()), 161);
  for (const auto& node : {std::array{12, 14, 16}, std::array{20, 9, 11}, std::array{14, 14, 14}}) {
    std::array<float, 4> pixel{};
    Eigen::Vector3d light;
    for (std::size_t k = 0; k < 3; ++k) {
      pixel[k] = static_cast<float>(node[k]) / 32.0F;
      light[static_cast<Eigen::Index>(k)] = spectral::decode(spectral::LogEncoding::AcesCct, node[k] / 32.0);
    }
    const Eigen::Vector3d expected = engine.apply(light);
    processor.apply(pixel);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(pixel[k], spectral::encode(spectral::LogEncoding::AcesCct, expected[static_cast<Eigen::Index>(k)]),
                  2e-6);
    }
  }
}

TEST(BakeTest, ToleranceTakesTheCheapestThatHoldsIt) {
  BakeOptions options;
  options.tolerance = 3.0;
  const Baked loose = bake(recipeOf("D65", "A"), testLibrary(), options);
  ASSERT_TRUE(loose.certificate.choice);
  const auto& tried = loose.certificate.choice->tried;
  ASSERT_GE(tried.size(), 2U);
  for (std::size_t k = 0; k + 1 < tried.size(); ++k) {
    EXPECT_GT(tried[k].p99, 3.0);
  }
  EXPECT_EQ(tried[0].representation, Representation::Identity);
  EXPECT_EQ(tried[1].representation, Representation::Matrix);
  EXPECT_LE(loose.certificate.error.p99, 3.0);
  EXPECT_EQ(loose.certificate.size, tried.back().size);
  options.tolerance = 100.0;
  EXPECT_EQ(bake(recipeOf("D65", "A"), testLibrary(), options).certificate.representation, Representation::Identity);
  options.tolerance.reset();
  options.representation = Representation::Matrix;
  const double matrix = bake(recipeOf("D65", "A"), testLibrary(), options).certificate.error.p99;
  EXPECT_NEAR(tried[1].p99, matrix, 1e-9);
}

TEST(BakeTest, ToleranceThatNothingHoldsIsRefusedWithTheBest) {
  const TemporaryFolder folder;
  BakeOptions options;
  options.tolerance = 0.01;
  options.size = 9;
  const std::string error =
      errorOf([&] { bakeFile(recipeOf("D65", "HP1"), testLibrary(), folder / "a.cube", {}, options); });
  EXPECT_NE(error.find("tolerance '0.01'"), std::string::npos) << error;
  EXPECT_NE(error.find("log cube of 9 nodes"), std::string::npos) << error;
  EXPECT_TRUE(folder.isEmpty());
}

// A narrower range is easier, and the certificate says which it was.
TEST(BakeTest, StopsAreWhatIsJudged) {
  BakeOptions options;
  options.representation = Representation::LogCube;
  options.size = 17;
  const Certificate wide = bake(recipeOf("D65", "HP1"), testLibrary(), options).certificate;
  options.lowestStop = -2;
  options.highestStop = 4;
  const Certificate narrow = bake(recipeOf("D65", "HP1"), testLibrary(), options).certificate;
  EXPECT_LT(narrow.error.p99, wide.error.p99);
  EXPECT_EQ(narrow.probes.lowestStop, -2);
  const auto json = nlohmann::json::parse(narrow.json());
  EXPECT_EQ(json["range"]["lowest_stop"], -2);
  EXPECT_EQ(json["transform"]["nodes"], "fitted");
  EXPECT_GT(json["diagnostics"]["gain"].get<double>(), 0.5);
  EXPECT_GE(json["diagnostics"]["folds"].get<double>(), 0.0);
  options.lowestStop = 5;
  EXPECT_NE(errorOf([&] { bake(recipeOf("D65", "HP1"), testLibrary(), options); }).find("must rise"),
            std::string::npos);
}

TEST(BakeTest, EveryFormatIsMeasuredAsWritten) {
  const TemporaryFolder folder;
  for (const char* name : {"a.ctf", "a.clf", "a.cube"}) {
    const auto file = folder / name;
    const Certificate certificate = bakeFile(recipeOf("D65", "A"), testLibrary(), file, {}, {.size = 17});
    EXPECT_EQ(certificate.sha256, sha256(contentsOf(file))) << name;
    const auto json = nlohmann::json::parse(contentsOf(file.string() + ".json"));
    EXPECT_EQ(json["transform"]["sha256"], certificate.sha256);
    EXPECT_NEAR(json["error"]["p99"].get<double>(), certificate.error.p99, 1e-4);
    EXPECT_EQ(json["transform"]["format"], lutFormat(file, "").name);
  }
}

TEST(CertificateTest, IsTheSameEveryTimeAndKeepsFoldersToItself) {
  const TemporaryFolder folder;
  std::ofstream(folder / "gel.csv") << "wavelength,transmittance\n380,0.5\n780,0.9\n";
  sip::Recipe recipe = recipeOf("D65", "A");
  recipe.output.filters.push_back({(folder / "gel.csv").string(), 0.5});
  bakeFile(recipe, testLibrary(), folder / "a.cube");
  const std::string first = contentsOf(folder / "a.cube.json");
  const std::string cube = contentsOf(folder / "a.cube");
  bakeFile(recipe, testLibrary(), folder / "a.cube");
  EXPECT_EQ(contentsOf(folder / "a.cube.json"), first);
  EXPECT_EQ(contentsOf(folder / "a.cube"), cube);
  EXPECT_EQ(first.find(folder.path().string()), std::string::npos);
  EXPECT_EQ(cube.find(folder.path().string()), std::string::npos);
  const auto json = nlohmann::json::parse(first);
  bool found = false;
  for (const auto& input : json["inputs"]) {
    EXPECT_EQ(input["sha256"].get<std::string>().size(), 64U) << input;
    if (input["name"] == "gel.csv") {
      found = true;
      EXPECT_EQ(input["sha256"], sha256(contentsOf(folder / "gel.csv")));
      EXPECT_EQ(input["role"], "output.filters[0]");
    }
  }
  EXPECT_TRUE(found);
}

// FIPS 180-2, appendix B.1.
TEST(CertificateTest, Sha256) {
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(BakeTest, WhatCannotBeBakedLeavesNothingBehind) {
  const TemporaryFolder folder;
  const auto error = [&](const sip::Recipe& recipe, const char* name, const BakeOptions& options = {}) {
    return errorOf([&] { bakeFile(recipe, testLibrary(), folder / name, {}, options); });
  };
  BakeOptions large;
  large.size = 130;
  BakeOptions shaped;
  shaped.shaper = spectral::LogEncoding::LogC3;
  sip::Recipe opaque = recipeOf("D65", "A");
  std::ofstream(folder / "opaque.csv") << "wavelength,transmittance\n380,0\n780,0\n";
  opaque.folder = folder.path();
  opaque.output.filters.push_back({"opaque.csv", 1.0});
  EXPECT_NE(error(recipeOf("D65", "D66"), "a.cube").find("D65"), std::string::npos);
  EXPECT_NE(error(recipeOf("D65", "A"), "a.cube", large).find("must be from 3 to 129"), std::string::npos);
  EXPECT_NE(error(recipeOf("D65", "A", "ACEScct"), "a.cube", shaped).find("leave the shaper out"), std::string::npos);
  EXPECT_NE(error(recipeOf("D65", "A"), "a.xyz").find("the formats are"), std::string::npos);
  EXPECT_NE(error(opaque, "a.cube").find("stop all the light"), std::string::npos);
  std::filesystem::remove(folder / "opaque.csv");
  EXPECT_TRUE(folder.isEmpty());
}

}  // namespace
}  // namespace metamer::ocio
