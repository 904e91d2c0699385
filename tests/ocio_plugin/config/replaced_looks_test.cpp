// SPDX-License-Identifier: Apache-2.0
// Looks that are renewed in a config, and the files that no look may take from others.
#include <gtest/gtest.h>

#include "config/config_document.h"
#include "metamer/ocio/config_writer.h"
#include "spectral/fixture.h"
#include "spectral/temporary_folder.h"

namespace metamer::ocio {
namespace {

using spectral::errorOf;
using spectral::testLibrary;

sip::Recipe recipeOf(const std::string& name, const std::string& to, double adaptation = 0.5) {
  sip::Recipe recipe;
  recipe.name = name;
  recipe.space = "ACEScg";
  recipe.input.illuminant = "D65";
  recipe.output.illuminant = to;
  recipe.adaptation = adaptation;
  // What is tested here does not depend on the scene; this one takes half the time.
  recipe.scene.kind = sip::ReferenceScene::Kind::Smooth;
  return recipe;
}

void put(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

class ReplacedLooksTest : public testing::Test {
 protected:
  ConfigReport write(const std::vector<sip::Recipe>& recipes, bool replaces, const std::string& base = "c.ocio",
                     const std::string& result = "c.ocio") {
    ConfigOptions options;
    options.size = 5;
    options.replaces = replaces;
    options.base = base.empty() ? std::filesystem::path() : folder / base;
    return writeConfig(recipes, testLibrary(), folder / result, options);
  }
  std::string textOf(const std::string& name) const { return contentsOf(folder / name); }

  TemporaryFolder folder;
};

constexpr const char* kBase =
    "ocio_profile_version: 2\n"
    "environment: {SHOW: plates, NAME: one}\n"
    "search_path: luts:$SHOW\n"
    "roles: {aces_interchange: AP0, scene_linear: AP0, default: AP0}\n"
    "displays:\n"
    "  sRGB:\n"
    "    - !<View> {name: Raw, colorspace: AP0}\n"
    "colorspaces:\n"
    "  - !<ColorSpace>\n"
    "    name: AP0\n";

TEST_F(ReplacedLooksTest, ALookIsRenewedInItsPlaceAndNothingElse) {
  write({recipeOf("one", "A"), recipeOf("two", "HP1"), recipeOf("three", "FL11")}, false, "");
  const std::string before = textOf("c.ocio");
  EXPECT_NE(errorOf([&] { write({recipeOf("Two", "D50")}, false); }).find("renew the look with --replace"),
            std::string::npos);
  const ConfigReport report = write({recipeOf("Two", "D50")}, true, "");  // the config to write is the base
  EXPECT_TRUE(report.isLoaded);
  const std::string after = textOf("c.ocio");
  EXPECT_LT(after.find("name: one\n"), after.find("name: Two\n"));
  EXPECT_LT(after.find("name: Two\n"), after.find("name: three\n"));
  EXPECT_LT(after.find("name: one - T"), after.find("name: Two - T"));
  EXPECT_LT(after.find("name: Two - T"), after.find("name: three - T"));
  EXPECT_EQ(after.find("name: two"), std::string::npos);
  EXPECT_EQ(after.find("HP1"), std::string::npos);
  EXPECT_EQ(before.substr(0, before.find("name: two")), after.substr(0, after.find("name: Two")));
  EXPECT_EQ(before.substr(before.find("  - !<Look>\n    name: three"), 60),
            after.substr(after.find("  - !<Look>\n    name: three"), 60));
  EXPECT_NE(textOf("luts/Two.json").find("D50"), std::string::npos);
  EXPECT_EQ(report.unused, std::vector<std::string>{"luts/two.ctf"});
  // The same again is the same.
  write({recipeOf("Two", "D50")}, true);
  EXPECT_EQ(textOf("c.ocio"), after);
  // One that is not there yet is added.
  write({recipeOf("four", "A"), recipeOf("one", "D50")}, true);
  EXPECT_GT(textOf("c.ocio").find("name: four\n"), textOf("c.ocio").find("name: three\n"));
}

TEST_F(ReplacedLooksTest, FilesThatOtherLooksReadStay) {
  write({recipeOf("dusk 0", "A", 0.0), recipeOf("dusk 100", "A", 1.0)}, false, "");  // both read dusk.ctf
  const std::string table = textOf("luts/dusk.ctf");
  const std::string certificate = textOf("luts/dusk_0.json");
  const std::string config = textOf("c.ocio");
  for (const auto& [recipe, replaces, file] : std::vector<std::tuple<sip::Recipe, bool, std::string>>{
           {recipeOf("dusk", "HP1"), false, "dusk.ctf"},
           {recipeOf("dusk_0", "HP1"), false, "dusk_0.json"},
       }) {
    const std::string error = errorOf([&, &recipe = recipe, replaces = replaces] { write({recipe}, replaces); });
    EXPECT_NE(error.find(file), std::string::npos) << error;
    EXPECT_NE(error.find("of the base; rename the recipe"), std::string::npos) << error;
  }
  EXPECT_EQ(textOf("c.ocio"), config);
  EXPECT_EQ(textOf("luts/dusk.ctf"), table);
  EXPECT_EQ(textOf("luts/dusk_0.json"), certificate);
  // One of the two alone gets a file of its own; both together, theirs anew.
  write({recipeOf("dusk 100", "HP1", 1.0)}, true);
  EXPECT_EQ(textOf("luts/dusk.ctf"), table);
  EXPECT_NE(textOf("c.ocio").find("dusk_100.ctf"), std::string::npos);
  write({recipeOf("dusk 0", "HP1", 0.0), recipeOf("dusk 100", "HP1", 1.0)}, true);
  EXPECT_NE(textOf("luts/dusk.ctf"), table);
}

TEST_F(ReplacedLooksTest, FilesOfTheBaseStayHoweverTheyAreFound) {
  std::filesystem::create_directory(folder / "luts");
  std::filesystem::create_directory(folder / "plates");
  const std::string table =
      "<?xml version=\"1.0\"?><!-- metamer --><ProcessList id=\"a\" version=\"1.3\"><Matrix inBitDepth=\"32f\" "
      "outBitDepth=\"32f\"><Array dim=\"3 3 3\">2 0 0 0 2 0 0 0 2</Array></Matrix></ProcessList>";
  for (const auto& [src, target] : std::vector<std::pair<std::string, std::string>>{
           {"one.ctf", "luts/one.ctf"},
           {"$NAME.ctf", "luts/one.ctf"},
           {"../luts/one.ctf", "luts/one.ctf"},
           {"link.ctf", "luts/one.ctf"},
           {"outer.ctf", "luts/one.ctf"},
       }) {
    put(folder / target, table);
    if (src == "link.ctf") {
      std::filesystem::create_symlink("one.ctf", folder / "luts" / src);
    }
    if (src == "outer.ctf") {
      put(folder / "luts" / src,
          "<?xml version=\"1.0\"?><ProcessList id=\"a\" version=\"1.3\"><Reference inBitDepth=\"32f\" "
          "outBitDepth=\"32f\" path=\"one.ctf\"/></ProcessList>");
    }
    put(folder / "c.ocio",
        std::string(kBase) + "  - !<ColorSpace>\n    name: graded\n    to_scene_reference: !<FileTransform> {src: \"" +
            src + "\"}\n");
    const std::string error = errorOf([&] { write({recipeOf("one", "A")}, false); });
    EXPECT_NE(error.find("is read by the config of the base"), std::string::npos) << src << ": " << error;
    EXPECT_EQ(textOf(target), table) << src;
  }
  // The config itself would stand where the base has a table.
  EXPECT_NE(errorOf([&] { write({recipeOf("two", "A")}, false, "c.ocio", "luts/one.ctf"); }).find("one.ctf"),
            std::string::npos);
  EXPECT_EQ(textOf("luts/one.ctf"), table);
  // What the base does not read may go.
  put(folder / "c.ocio", kBase);
  write({recipeOf("one", "A")}, false);
  EXPECT_NE(textOf("luts/one.ctf"), table);
}

TEST_F(ReplacedLooksTest, TwoRecipesOfOneFileAreRefused) {
  const std::string error = errorOf([&] { write({recipeOf("a b", "A"), recipeOf("a_b", "HP1")}, false, ""); });
  EXPECT_NE(error.find("would hold both 'a b' and 'a_b'"), std::string::npos) << error;
  EXPECT_TRUE(folder.isEmpty());
}

TEST_F(ReplacedLooksTest, ItemsAreReplacedHoweverTheyAreWritten) {
  constexpr const char* kNew = "- !<Look>\n  name: b\n  process_space: lin\n";
  const auto renewed = [&](const std::string& text) {
    return ConfigDocument(text, "base").with(kNew, "", "", "", true);
  };
  const std::string head = "ocio_profile_version: 2\nlooks:\n";
  EXPECT_EQ(renewed(head + "  - !<Look> {name: a}\n  # on b\n  - !<Look> {name: B}  # gone\n\n  # on c\n  - !<Look>\n"
                           "    name: c\n"),
            head +
                "  - !<Look> {name: a}\n  # on b\n  - !<Look>\n    name: b\n    process_space: lin\n\n  # on c\n"
                "  - !<Look>\n    name: c\n");
  EXPECT_EQ(renewed(head + "-\n  name: b\n  description: |\n    # text\n\n    more\n\n# roles\nroles: {}\n"),
            head + "- !<Look>\n  name: b\n  process_space: lin\n\n# roles\nroles: {}\n");
  EXPECT_EQ(renewed(head + "- !<Look> {name: b,\n  process_space: x}"),
            head + "- !<Look>\n  name: b\n  process_space: lin\n");
  EXPECT_NE(errorOf([&] { renewed("ocio_profile_version: 2\nlooks: [!<Look> {name: b}]\n"); }).find("base:2: looks"),
            std::string::npos);
  // An anchor that others need cannot go.
  EXPECT_NE(
      errorOf([&] {
        renewed(head + "  - !<Look> {name: b, process_space: &p lin}\n  - !<Look> {name: c, process_space: *p}\n");
      }).find("base:"),
      std::string::npos);
}

}  // namespace
}  // namespace metamer::ocio
