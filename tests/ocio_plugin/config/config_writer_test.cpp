// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/config_writer.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "metamer/ocio/compared_transform.h"
#include "metamer/ocio/pixel_processor.h"
#include "spectral/fixture.h"
#include "spectral/temporary_folder.h"

namespace metamer::ocio {
namespace {

using spectral::errorOf;
using spectral::testLibrary;

sip::Recipe recipeOf(const std::string& name, const std::string& from, const std::string& to, double adaptation = 0.5,
                     const std::string& space = "ACEScg") {
  sip::Recipe recipe;
  recipe.name = name;
  recipe.space = space;
  recipe.input.illuminant = from;
  recipe.output.illuminant = to;
  recipe.adaptation = adaptation;
  // What is tested here does not depend on the scene; this one takes half the time.
  recipe.scene.kind = sip::ReferenceScene::Kind::Smooth;
  return recipe;
}

ConfigReport write(const std::vector<sip::Recipe>& recipes, const std::filesystem::path& file,
                   ConfigOptions options = {}) {
  options.size = 17;
  return writeConfig(recipes, testLibrary(), file, options);
}

void put(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

OCIO::ConstProcessorRcPtr lookOf(const std::filesystem::path& file, const std::string& name, const char* space) {
  auto look = OCIO::LookTransform::Create();
  look->setSrc(space);
  look->setDst(space);
  look->setLooks(name.c_str());
  return OCIO::Config::CreateFromFile(file.c_str())->getProcessor(look);
}

std::array<float, 3> applied(const OCIO::ConstProcessorRcPtr& processor, std::array<float, 3> rgb) {
  processor->getDefaultCPUProcessor()->applyRGB(rgb.data());
  return rgb;
}

constexpr const char* kBase =
    "ocio_profile_version: 2\n"
    "search_path: \"\"\n"
    "roles: {aces_interchange: AP0, scene_linear: AP0, default: AP0}\n"
    "displays:\n"
    "  sRGB:\n"
    "    - !<View> {name: Raw, colorspace: AP0}\n"
    "colorspaces:\n"
    "  - !<ColorSpace>\n"
    "    name: AP0\n"
    "  - !<ColorSpace>\n"
    "    name: half\n"
    "    to_scene_reference: !<MatrixTransform> {matrix: [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1]}\n"
    "  - !<ColorSpace>\n"
    "    name: raw\n"
    "    isdata: true\n";

TEST(ConfigWriterTest, RecipesThatDifferInAdaptationShareAFile) {
  const TemporaryFolder folder;
  const ConfigReport report = write({recipeOf("sodium 0", "D65", "HP1", 0.0), recipeOf("sodium 50", "D65", "HP1", 0.5),
                                     recipeOf("sodium 100", "D65", "HP1", 1.0), recipeOf("warm", "D65", "A", 0.5)},
                                    folder / "c.ocio");
  ASSERT_EQ(report.entries.size(), 4U);
  EXPECT_TRUE(report.isLoaded);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(report.entries[static_cast<std::size_t>(k)].file, "luts/sodium.ctf");
  }
  EXPECT_EQ(report.entries[3].file, "luts/warm.ctf");
  // A shared table is fitted for the middle adaptation: an end may lose up to a quarter of its error to the other, and
  // together they lose no more than a tenth against tables of their own.
  double shared = 0;
  double ofTheirOwn = 0;
  for (const ConfigEntry& entry : report.entries) {
    BakeOptions options;
    options.size = 17;
    const Certificate alone = bake(entry.certificate.recipe, testLibrary(), options).certificate;
    EXPECT_LE(entry.certificate.error.mean, 1.25 * alone.error.mean) << entry.name;
    shared += entry.certificate.error.mean;
    ofTheirOwn += alone.error.mean;
    EXPECT_TRUE(std::filesystem::exists(folder / entry.file));
  }
  EXPECT_LE(shared, 1.1 * ofTheirOwn);
  const auto json = nlohmann::json::parse(contentsOf(folder / "luts" / "sodium_50.json"));
  EXPECT_EQ(json["recipe"]["output"]["adaptation"], 0.5);
  EXPECT_EQ(json["transform"]["sha256"], sha256(contentsOf(folder / "luts/sodium.ctf")));
}

TEST(ConfigWriterTest, TheLeastThatHoldsATolerance) {
  const TemporaryFolder folder;
  const auto entryAt = [&](double tolerance, int size) {
    ConfigOptions options;
    options.tolerance = tolerance;
    options.size = size;
    return writeConfig({recipeOf("look", "D65", "A", 0.5)}, testLibrary(),
                       folder / (std::to_string(tolerance) + ".ocio"), options)
        .entries[0];
  };
  const ConfigEntry matrix = entryAt(100.0, 65);
  EXPECT_EQ(matrix.certificate.representation, Representation::Matrix);
  EXPECT_TRUE(matrix.file.empty());
  EXPECT_GT(matrix.certificate.error.p99, 0.5);
  int last = 0;
  for (const double tolerance : {2.0, 0.8}) {
    const ConfigEntry entry = entryAt(tolerance, 33);
    EXPECT_EQ(entry.certificate.representation, Representation::ExposureInvariantChain);
    EXPECT_LE(entry.certificate.error.p99, tolerance);
    EXPECT_GE(entry.certificate.size, last);
    last = entry.certificate.size;
  }
  EXPECT_LT(last, 33);
  // What cannot be held: the largest that was allowed.
  const ConfigEntry least = entryAt(1e-4, 9);
  EXPECT_EQ(least.certificate.size, 9);
  EXPECT_GT(least.certificate.error.p99, 1e-4);
}

TEST(ConfigWriterTest, ALookIsItsRecipeInWhateverSpace) {
  const TemporaryFolder folder;
  // The last two: of the config itself, and built in but not in the config.
  put(folder / "base.ocio", kBase);
  ConfigOptions options;
  int count = 0;
  for (const char* space : {"ACEScct", "ARRI LogC4", "Rec.709", "half"}) {
    options.base = std::string(space) == "half" || std::string(space) == "Rec.709" ? folder / "base.ocio" : "";
    // OCIO keeps what it has read by name: files of their own.
    const std::string name = "look " + std::to_string(++count);
    const std::filesystem::path file = folder / (name + ".ocio");
    const sip::Recipe recipe = recipeOf(name, "D65", "A", 0.5, space);
    const ConfigReport report = write({recipe}, file, options);
    const auto look = comparedLook(file, recipe.name, testLibrary());
    sip::Recipe linear = recipe;
    if (std::string(space) == "half") {
      linear.space = "ACES2065-1";
    }
    const auto engine = comparedRecipe(linear, testLibrary(), nullptr);
    const auto comparison = compareTransforms(engine, look, engine.space, testLibrary());
    // What the certificate says, but for the float matrices between the spaces.
    EXPECT_NEAR(comparison.mean, report.entries[0].certificate.error.mean, 2e-3) << space;
    EXPECT_NEAR(comparison.max, report.entries[0].certificate.error.max, 0.1) << space;
  }
}

TEST(ConfigWriterTest, ANamedTransformIsOnTheRecipesPixels) {
  const TemporaryFolder folder;
  write({recipeOf("look", "D65", "A", 0.5, "ARRI LogC3")}, folder / "c.ocio");
  const auto config = OCIO::Config::CreateFromFile((folder / "c.ocio").c_str());
  const auto named = config->getNamedTransform("look - Transform");
  ASSERT_TRUE(named);
  EXPECT_STREQ(named->getEncoding(), "log");
  EXPECT_STREQ(named->getFamily(), "metamer/Light/D65");
  EXPECT_GE(named->getNumCategories(), 1);
  EXPECT_GT(std::string(named->getDescription()).size(), 40U);
  const std::array<float, 3> pixel = {0.5F, 0.35F, 0.42F};
  const auto onPixels = applied(config->getProcessor(named->getTransform(OCIO::TRANSFORM_DIR_FORWARD)), pixel);
  const auto byLook = applied(lookOf(folder / "c.ocio", "look", "ARRI LogC3 (EI800)"), pixel);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(onPixels[k], byLook[k], 2e-6);
    EXPECT_GT(std::abs(onPixels[k] - pixel[k]), 1e-3);
  }
}

TEST(ConfigWriterTest, ABaseIsKeptAndCanBeAddedToAgain) {
  const TemporaryFolder folder;
  put(folder / "base.ocio", kBase);
  ConfigOptions options;
  options.base = folder / "base.ocio";
  write({recipeOf("one", "D65", "A")}, folder / "base.ocio", options);  // in place
  const std::string once = contentsOf(folder / "base.ocio");
  EXPECT_NE(once.find("search_path: luts\n"), std::string::npos);
  write({recipeOf("two", "D65", "HP1")}, folder / "base.ocio", options);
  const std::string twice = contentsOf(folder / "base.ocio");
  EXPECT_NE(twice.find("search_path: luts\n"), std::string::npos);
  EXPECT_EQ(OCIO::Config::CreateFromFile((folder / "base.ocio").c_str())->getNumLooks(), 2);
  EXPECT_NE(errorOf([&] { write({recipeOf("TWO", "D65", "HP1")}, folder / "base.ocio", options); }).find("look 'TWO'"),
            std::string::npos);
  EXPECT_EQ(contentsOf(folder / "base.ocio"), twice);
}

TEST(ConfigWriterTest, ALaterProfileIsAddedToWithoutLoadingIt) {
  const TemporaryFolder folder;
  std::string base = kBase;
  base.replace(base.find("version: 2"), 10, "version: 2.99");
  put(folder / "base.ocio", base + "something_new: {of: later releases}\n");
  ConfigOptions options;
  options.base = folder / "base.ocio";
  const ConfigReport report = write({recipeOf("one", "D65", "A")}, folder / "out.ocio", options);
  EXPECT_FALSE(report.isLoaded);
  EXPECT_EQ(report.minorVersion, 99);
  EXPECT_NE(contentsOf(folder / "out.ocio").find("something_new: {of: later releases}\n"), std::string::npos);
}

TEST(ConfigWriterTest, FilesOfTheBaseMustBeFoundFromTheNewPlace) {
  const TemporaryFolder folder;
  const std::string withFile = std::string(kBase) +
                               "  - !<ColorSpace>\n    name: graded\n    to_scene_reference: !<FileTransform> {src: "
                               "grade.spi1d}\n";
  put(folder / "base.ocio", withFile);
  ConfigOptions options;
  options.base = folder / "base.ocio";
  const auto error = [&](const std::filesystem::path& file) {
    return errorOf([&] { write({recipeOf("one", "D65", "A")}, file, options); });
  };
  EXPECT_NE(error(folder / "out.ocio").find("src 'grade.spi1d': is not in the search path"), std::string::npos);
  put(folder / "grade.spi1d", "Version 1\nFrom 0 1\nLength 2\nComponents 1\n{\n0\n1\n}\n");
  std::filesystem::create_directory(folder / "other");
  EXPECT_NE(error(folder / "other" / "out.ocio").find("from the base's own folder only"), std::string::npos);
  EXPECT_TRUE(std::filesystem::is_empty(folder / "other"));
}

TEST(ConfigWriterTest, AFileBesideTheBaseIsStillFoundWithASearchPath) {
  const TemporaryFolder folder;
  std::string base = kBase;
  // OCIO refuses files without a search path: this one has its own folder as one.
  base.replace(base.find("search_path: \"\""), 15, "search_path: .");
  put(folder / "base.ocio",
      base + "  - !<ColorSpace>\n    name: graded\n    to_scene_reference: !<FileTransform> {src: grade.spi1d}\n");
  put(folder / "grade.spi1d", "Version 1\nFrom 0 1\nLength 2\nComponents 1\n{\n0\n0.5\n}\n");
  ConfigOptions options;
  options.base = folder / "base.ocio";
  write({recipeOf("one", "D65", "A")}, folder / "out.ocio", options);
  const auto config = OCIO::Config::CreateFromFile((folder / "out.ocio").c_str());
  EXPECT_NEAR(applied(config->getProcessor("graded", "AP0"), {1.0F, 1.0F, 1.0F})[0], 0.5F, 1e-6);
  EXPECT_STREQ(config->getSearchPath(), ".");
  applied(lookOf(folder / "out.ocio", "one", "AP0"), {0.2F, 0.2F, 0.2F});
}

TEST(ConfigWriterTest, BadBasesAreNamed) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& text) {
    put(folder / "base.ocio", text);
    ConfigOptions options;
    options.base = folder / "base.ocio";
    return errorOf([&] { write({recipeOf("one", "D65", "A")}, folder / "out.ocio", options); });
  };
  const auto replaced = [](std::string text, const std::string& what, const std::string& by) {
    return text.replace(text.find(what), what.size(), by);
  };
  EXPECT_NE(error("ocio_profile_version: [").find("is no YAML"), std::string::npos);
  EXPECT_NE(error(replaced(kBase, "version: 2", "version: 1")).find("upgradeToLatestVersion"), std::string::npos);
  EXPECT_NE(error(replaced(kBase, "aces_interchange: AP0, ", "")).find("role 'aces_interchange': is missing"),
            std::string::npos);
  EXPECT_NE(error(replaced(kBase, "aces_interchange: AP0", "aces_interchange: AP9")).find("'AP9'"), std::string::npos);
  EXPECT_NE(error(replaced(kBase, "!<MatrixTransform>", "!<MatricesTransform>")).find("OCIO refuses it"),
            std::string::npos);
  EXPECT_NE(error(replaced(kBase, "isdata: true", "isdata: [")).find("base.ocio:"), std::string::npos);
  ConfigOptions options;
  for (const char* base : {"missing.ocio", "ocio://nothing", "config.ocioz"}) {
    options.base = base;
    EXPECT_NE(errorOf([&] { write({recipeOf("one", "D65", "A")}, folder / "out.ocio", options); }).find(base),
              std::string::npos);
  }
  std::filesystem::remove(folder / "base.ocio");
  EXPECT_TRUE(folder.isEmpty()) << "something is left behind";
}

TEST(ConfigWriterTest, BadRecipesAndPlacesAreNamed) {
  const TemporaryFolder folder;
  const auto error = [&](const sip::Recipe& recipe, ConfigOptions options = {}) {
    return errorOf([&] { write({recipe}, folder / "out.ocio", options); });
  };
  EXPECT_NE(error(recipeOf("one", "D65", "HP9")).find("'HP9'"), std::string::npos);
  EXPECT_NE(error(recipeOf("one", "D65", "HP1", 0.0, "ACESc")).find("space 'ACESc'"), std::string::npos);
  EXPECT_NE(error(recipeOf("one", "D65", "HP1", 0.0, "Raw")).find("holds data"), std::string::npos);
  EXPECT_NE(error(recipeOf("ACEScg", "D65", "A")).find("name 'ACEScg'"), std::string::npos);
  for (const char* name : {"a,b", "a|b", "a:b", "-a", "+a", "$a", "", "a/b"}) {
    EXPECT_NE(error(recipeOf(name, "D65", "A")).find("cannot be the name of a look"), std::string::npos) << name;
  }
  EXPECT_NE(errorOf([&] {
              write({recipeOf("a", "D65", "A"), recipeOf("A", "D65", "A")}, folder / "out.ocio");
            }).find("another recipe"),
            std::string::npos);
  ConfigOptions options;
  options.lutFolder = "../luts";
  EXPECT_NE(error(recipeOf("a", "D65", "A"), options).find("LUT folder '../luts'"), std::string::npos);
  EXPECT_NE(errorOf([&] { write({recipeOf("a", "D65", "A")}, folder / "no" / "out.ocio"); }).find("out.ocio"),
            std::string::npos);
  EXPECT_TRUE(folder.isEmpty()) << "something is left behind";
  // Somebody's file of that name.
  std::filesystem::create_directory(folder / "luts");
  put(folder / "luts" / "a.ctf", "<ProcessList/>");
  EXPECT_NE(error(recipeOf("a", "D65", "A")).find("not metamer's"), std::string::npos);
  EXPECT_EQ(contentsOf(folder / "luts" / "a.ctf"), "<ProcessList/>");
}

TEST(ConfigWriterTest, TheSameRecipesGiveTheSameBytes) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "a");
  std::filesystem::create_directory(folder / "b");
  for (const char* place : {"a", "b"}) {
    write({recipeOf("x_0", "D65", "LED-RGB1", 0.0), recipeOf("x_1", "D65", "LED-RGB1", 1.0)},
          folder / place / "c.ocio");
  }
  for (const char* file : {"c.ocio", "luts/x.ctf", "luts/x_0.json", "luts/x_1.json"}) {
    EXPECT_EQ(contentsOf(folder / "a" / file), contentsOf(folder / "b" / file)) << file;
    EXPECT_FALSE(contentsOf(folder / "a" / file).empty());
  }
}

}  // namespace
}  // namespace metamer::ocio
