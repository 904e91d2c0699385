// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/recipe.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <clocale>
#include <cmath>
#include <fstream>

#include "sip/sip_fixture.h"

namespace metamer::sip {
namespace {

constexpr const char* kShortest = "metamer: 1\ninput: {illuminant: D65}\noutput: {illuminant: HP1}\n";

Recipe parse(const std::string& text) {
  return parseRecipe(text, "r.yaml");
}

std::string repeated(const std::string& text, int count) {
  std::string result;
  for (int i = 0; i < count; ++i) {
    result += text;
  }
  return result;
}

/// A folder of its own that goes away with the test.
class RecipeFileTest : public testing::Test {
 protected:
  RecipeFileTest()
      : m_folder(std::filesystem::temp_directory_path() / ("metamer_recipe_test_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(m_folder);
  }
  ~RecipeFileTest() override { std::filesystem::remove_all(m_folder); }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(m_folder / name, std::ios::binary) << text;
    return m_folder / name;
  }

  std::filesystem::path m_folder;
};

TEST(RecipeTest, EveryField) {
  const Recipe recipe = parse(R"(
# a comment
metamer: 1
name: day_to_sodium
space: ARRI Wide Gamut 4
input:  {illuminant: 3200 K, filters: [Lee 201, {name: Lee 204, density: 2}], observer: CIE 1964 10}
output:
  illuminant: HP1
  filters: [{file: gel.csv, density: 0.5}]
  observer: "Nikon D5100"
  adaptation: .25
scene:
  kind: skin
  strength: 5e-1
  fade: 1.5
cat: cat16
balanced: camera
keep_exposure: true
)");
  EXPECT_EQ(recipe.name, "day_to_sodium");
  EXPECT_EQ(recipe.space, "ARRI Wide Gamut 4");
  EXPECT_EQ(recipe.input.illuminant, "3200 K");
  ASSERT_EQ(recipe.input.filters.size(), 2U);
  EXPECT_EQ(recipe.input.filters[0].name, "Lee 201");
  EXPECT_EQ(recipe.input.filters[0].density, 1.0);
  EXPECT_EQ(recipe.input.filters[1].name, "Lee 204");
  EXPECT_EQ(recipe.input.filters[1].density, 2.0);
  EXPECT_EQ(recipe.input.observer, "CIE 1964 10");
  EXPECT_EQ(recipe.output.illuminant, "HP1");
  ASSERT_EQ(recipe.output.filters.size(), 1U);
  EXPECT_EQ(recipe.output.filters[0].name, "./gel.csv");  // a file, whatever data/ calls so
  EXPECT_EQ(recipe.output.filters[0].density, 0.5);
  EXPECT_EQ(recipe.output.observer, "Nikon D5100");
  EXPECT_EQ(recipe.adaptation, 0.25);
  EXPECT_EQ(recipe.scene.kind, ReferenceScene::Kind::Skin);
  EXPECT_EQ(recipe.scene.strength, 0.5);
  EXPECT_EQ(recipe.scene.fade, 1.5);
  EXPECT_EQ(recipe.cat, spectral::ChromaticAdaptation::Cat16);
  EXPECT_EQ(recipe.balanced, Balance{.kind = Balance::Kind::Camera});
  EXPECT_TRUE(recipe.keepExposure);
}

TEST(RecipeTest, Defaults) {
  const Recipe recipe = parse(kShortest);
  EXPECT_EQ(toYaml(recipe),
            "metamer: 1\n"
            "name: transform\n"
            "space: ACEScg\n"
            "input: {illuminant: D65, filters: [], observer: \"CIE 1931 2\"}\n"
            "output: {illuminant: HP1, filters: [], observer: \"CIE 1931 2\", adaptation: 0}\n"
            "scene: {kind: natural}\n"
            "cat: vonkries\n"
            "balanced: vonkries\n"
            "keep_exposure: false\n");
}

TEST(RecipeTest, PairsReachAsFarAsTheSceneBelowThemLetsThem) {
  const std::string start = "metamer: 1\ninput: {illuminant: D65}\noutput: {illuminant: A}\n";
  const auto sceneOf = [&](const char* text) { return parse(start + text).scene; };
  EXPECT_EQ(sceneOf("scene: {kind: pairs, set: a.csv}\n").over, ReferenceScene::Kind::Natural);
  EXPECT_EQ(sceneOf("scene: {kind: pairs, set: a.csv}\n").radius, kDefaultPairRadius);
  EXPECT_EQ(sceneOf("scene: {kind: pairs, set: a.csv, over: smooth}\n").radius, kSmoothPairRadius);
  EXPECT_EQ(sceneOf("scene: {kind: pairs, set: a.csv, over: smooth, radius: 1.5}\n").radius, 1.5);
  EXPECT_EQ(sceneOf("scene: {kind: pairs, set: a.csv, over: skin, strength: 0.5}\n").strength, 0.5);
  for (const char* const scene : {"{kind: pairs, set: \"a.csv\", over: smooth, radius: 1.5}",
                                  "{kind: pairs, set: \"a.csv\", over: skin, radius: 0.5, strength: 0.5, fade: 2.5}"}) {
    const std::string text = toYaml(parse(start + "scene: " + scene + "\n"));
    EXPECT_NE(text.find(std::string("scene: ") + scene), std::string::npos) << text;
  }
}

TEST(RecipeTest, YamlReadsBackAsTheSameRecipe) {
  Recipe recipe;
  recipe.name = R"(it's "odd": [a, b] # \ {é} - ~)";
  recipe.space = "null";
  recipe.input = {"- 3200 K", {{"Lee 201", 1.0 / 3.0}, {"C:\\gels\\a b.csv", 0.0}, {"a/b", 1e-300}}, " true "};
  recipe.output = {"&anchor", {{"*alias", 100.0}}, "%directive @ `"};
  recipe.adaptation = 0.1;
  recipe.scene = {ReferenceScene::Kind::Dataset, "!tag", 1.0};
  recipe.cat = spectral::ChromaticAdaptation::Cat02;
  recipe.balanced = Balance{.kind = Balance::Kind::None};
  recipe.keepExposure = true;
  const Recipe back = parse(toYaml(recipe));
  EXPECT_EQ(back.name, recipe.name);
  EXPECT_EQ(back.space, recipe.space);
  for (const auto side : {&Recipe::input, &Recipe::output}) {
    EXPECT_EQ((back.*side).illuminant, (recipe.*side).illuminant);
    EXPECT_EQ((back.*side).observer, (recipe.*side).observer);
    ASSERT_EQ((back.*side).filters.size(), (recipe.*side).filters.size());
    for (std::size_t i = 0; i < (recipe.*side).filters.size(); ++i) {
      EXPECT_EQ((back.*side).filters[i].name, (recipe.*side).filters[i].name);
      EXPECT_EQ((back.*side).filters[i].density, (recipe.*side).filters[i].density);
    }
  }
  EXPECT_EQ(back.adaptation, recipe.adaptation);
  EXPECT_EQ(back.scene.kind, recipe.scene.kind);
  EXPECT_EQ(back.scene.set, recipe.scene.set);
  EXPECT_EQ(back.scene.strength, recipe.scene.strength);
  EXPECT_EQ(back.scene.fade, recipe.scene.fade);
  EXPECT_EQ(back.cat, recipe.cat);
  EXPECT_EQ(back.balanced, recipe.balanced);
  EXPECT_EQ(back.keepExposure, recipe.keepExposure);
  EXPECT_EQ(toYaml(back), toYaml(recipe));
  for (const auto kind : {ReferenceScene::Kind::Natural, ReferenceScene::Kind::Smooth, ReferenceScene::Kind::Skin}) {
    recipe.scene = {kind, "", kind == ReferenceScene::Kind::Skin ? 0.3 : 1.0,
                    kind == ReferenceScene::Kind::Skin ? 3.5 : kDefaultSkinFade};
    const Recipe other = parse(toYaml(recipe));
    EXPECT_EQ(other.scene.kind, kind);
    EXPECT_EQ(other.scene.strength, recipe.scene.strength);
    EXPECT_EQ(other.scene.fade, recipe.scene.fade);
  }
}

TEST(RecipeTest, RefusesMalformedRecipes) {
  struct Case {
    const char* name;
    std::string text;
    std::string error;
  };
  const std::string density = "must be a number from 0 to 100";
  const auto with = [](const std::string& more) { return kShortest + more; };
  const auto filtered = [](const std::string& filters) {
    return "metamer: 1\ninput: {illuminant: D65}\noutput:\n  illuminant: HP1\n  filters: " + filters + "\n";
  };
  const std::vector<Case> cases{
      {"empty", "", "r.yaml: recipe: is empty; a recipe starts with 'metamer: 1'"},
      {"white space", "\n  \n", "r.yaml: recipe: is empty; a recipe starts with 'metamer: 1'"},
      {"comment", "# nothing\n", "r.yaml: recipe: is empty; a recipe starts with 'metamer: 1'"},
      {"list at the top", "- metamer: 1\n",
       "r.yaml:1: recipe: must be a map of metamer, name, space, input, output, scene, cat, balanced, keep_exposure, "
       "such as "
       "'metamer: 1'"},
      {"text at the top", "metamer\n",
       "r.yaml:1: recipe 'metamer': must be a map of metamer, name, space, input, output, scene, cat, balanced, "
       "keep_exposure, "
       "such as 'metamer: 1'"},
      {"quoted version", "metamer: '1'\n",
       "r.yaml:1: metamer '1': is a version this release does not read; it reads 1, a number without quotes"},
      {"Latin-1", "metamer: 1\nname: caf\xE9\n",
       "r.yaml: text encoding: byte 21 is not UTF-8 (Latin-1?); save the file as UTF-8"},
      {"no version", "input: {illuminant: D65}\n", "r.yaml:1: metamer: is missing; a recipe starts with 'metamer: 1'"},
      {"version 2", "metamer: 2\n", "r.yaml:1: metamer '2': is a version this release does not read; it reads 1"},
      {"version as a list", "metamer: [1]\n", "r.yaml:1: metamer: is a version this release does not read; it reads 1"},
      {"unknown key", with("scean: {kind: smooth}\n"),
       "r.yaml:4: key 'scean': unknown; the keys here are metamer, name, space, input, output, scene, cat, balanced, "
       "keep_exposure"},
      {"unknown key below", "metamer: 1\ninput: {illuminant: D65,\n  filter: []}\noutput: {illuminant: A}\n",
       "r.yaml:3: key 'input.filter': unknown; did you mean 'filters'? the keys here are illuminant, filters, "
       "observer"},
      {"repeated key", with("cat: cat16\nname: a\ncat: cat16\n"), "r.yaml:6: key 'cat': is given twice; keep one"},
      {"repeated key below", "metamer: 1\ninput: {illuminant: D65, illuminant: A}\noutput: {illuminant: A}\n",
       "r.yaml:2: key 'input.illuminant': is given twice; keep one"},
      {"map as a key", "{metamer: 1}: 1\n", "r.yaml:1: key: a key must be a plain word"},
      {"no input", "metamer: 1\noutput: {illuminant: A}\n",
       "r.yaml:1: input: is missing; give the light, such as 'input: {illuminant: D65}'"},
      {"no illuminant", "metamer: 1\ninput: {illuminant: D65}\noutput: {filters: []}\n",
       "r.yaml:3: output.illuminant: is missing; name the light, such as 'illuminant: D65'"},
      {"illuminant of nothing", "metamer: 1\ninput: {illuminant: }\noutput: {illuminant: A}\n",
       "r.yaml:2: input.illuminant: is empty; give a name or leave the key out"},
      {"empty illuminant", "metamer: 1\ninput: {illuminant: ''}\noutput: {illuminant: A}\n",
       "r.yaml:2: input.illuminant: is empty; give a name or leave the key out"},
      {"list for text", with("name: [a]\n"), "r.yaml:4: name: must be a name, not a list"},
      {"two lines of text", with("name: \"a\\nb\"\n"), "r.yaml:4: value 'a b': control characters are not allowed"},
      {"half a character", with("name: \"a\\Nb\"\n"),
       "r.yaml:4: value: the escapes \\N and \\_ cannot be read; write the character itself"},
      {"a bell", with("name: \"a\\ab\"\n"), "r.yaml:4: value 'a b': control characters are not allowed"},
      {"text for a map", "metamer: 1\ninput: D65\noutput: {illuminant: A}\n",
       "r.yaml:2: input 'D65': must be a map of illuminant, filters, observer"},
      {"text for a number", filtered("[{name: Lee 201, density: thick}]"),
       "r.yaml:5: output.filters[0].density 'thick': " + density},
      {"number in quotes", filtered("[{name: Lee 201, density: '1'}]"),
       "r.yaml:5: output.filters[0].density '1': " + density},
      {"text after a number", filtered("[{name: Lee 201, density: 1.0x}]"),
       "r.yaml:5: output.filters[0].density '1.0x': " + density},
      {"decimal comma", filtered("\n  - name: Lee 201\n    density: 1,5"),
       "r.yaml:7: output.filters[0].density '1,5': " + density},
      {"hexadecimal", filtered("[{name: Lee 201, density: 0x1}]"),
       "r.yaml:5: output.filters[0].density '0x1': " + density},
      {"NaN density", filtered("[Lee 204, {name: Lee 201, density: nan}]"),
       "r.yaml:5: output.filters[1].density 'nan': " + density},
      {"YAML's NaN", filtered("[{name: Lee 201, density: .nan}]"),
       "r.yaml:5: output.filters[0].density '.nan': " + density},
      {"infinite density", filtered("[{name: Lee 201, density: inf}]"),
       "r.yaml:5: output.filters[0].density 'inf': " + density},
      {"overflow", filtered("[{name: Lee 201, density: 1e999}]"),
       "r.yaml:5: output.filters[0].density '1e999': " + density},
      {"negative density", filtered("[{name: Lee 201, density: -0.5}]"),
       "r.yaml:5: output.filters[0].density '-0.5': " + density},
      {"list for a number", filtered("[{name: Lee 201, density: []}]"),
       "r.yaml:5: output.filters[0].density: must be a number from 0 to 100"},
      {"filters as text", filtered("Lee 201"), "r.yaml:5: output.filters 'Lee 201': must be a list, such as [gel.csv]"},
      {"filter as a list", filtered("[[Lee 201]]"),
       "r.yaml:5: output.filters[0]: must be a map of name, file, density"},
      {"filter without a name", filtered("[{density: 1}]"),
       "r.yaml:5: output.filters[0]: must have either a name or a file"},
      {"filter with two names", filtered("[{name: Lee 201, file: a.csv}]"),
       "r.yaml:5: output.filters[0]: must have either a name or a file"},
      {"adaptation out of range", "metamer: 1\ninput: {illuminant: D65}\noutput: {illuminant: A, adaptation: 1.01}\n",
       "r.yaml:3: output.adaptation '1.01': must be a number from 0 to 1"},
      {"unknown scene", with("scene: {kind: smoth}\n"),
       "r.yaml:4: scene.kind 'smoth': must be natural, skin, pairs, smooth, dataset, smits, mallett, jakob or meng"},
      {"set for smooth", with("scene: {kind: smooth, set: skin}\n"),
       "r.yaml:4: scene.set 'skin': has a meaning with kind dataset or pairs alone; leave it out"},
      {"set for the default", with("scene: {set: skin}\n"),
       "r.yaml:4: scene.set 'skin': has a meaning with kind dataset or pairs alone; leave it out"},
      {"dataset without set", with("scene:\n  kind: dataset\n"),
       "r.yaml:5: scene.set: is missing; name a reflectance set (see: lutgen list reflectances)"},
      {"strength for natural", with("scene: {kind: natural, strength: 0.5}\n"),
       "r.yaml:4: scene.strength '0.5': has a meaning with kind skin alone; leave it out"},
      {"strength out of range", with("scene: {kind: skin, strength: 2}\n"),
       "r.yaml:4: scene.strength '2': must be a number from 0 to 1"},
      {"fade for smooth", with("scene: {kind: smooth, fade: 2}\n"),
       "r.yaml:4: scene.fade '2': has a meaning with kind skin alone; leave it out"},
      {"fade out of range", with("scene: {kind: skin, fade: 9}\n"),
       "r.yaml:4: scene.fade '9': must be a number from 0.5 to 4"},
      {"radius for skin", with("scene: {kind: skin, radius: 0.1}\n"),
       "r.yaml:4: scene.radius '0.1': has a meaning with kind pairs alone; leave it out"},
      {"radius out of range", with("scene: {kind: pairs, set: a.csv, radius: 0}\n"),
       "r.yaml:4: scene.radius '0': must be a number from 0.05 to 20"},
      {"pairs without set", with("scene: {kind: pairs}\n"),
       "r.yaml:4: scene.set: is missing; name the file of the colours and their spectra (see: lutgen pairs add)"},
      {"pairs over themselves", with("scene: {kind: pairs, set: a.csv, over: pairs}\n"),
       "r.yaml:4: scene.over 'pairs': must be natural, skin or smooth"},
      {"pairs over natural have no strength", with("scene: {kind: pairs, set: a.csv, strength: 1}\n"),
       "r.yaml:4: scene.strength '1': has a meaning with kind skin alone; leave it out"},
      {"unknown cat", with("cat: cat61\n"), "r.yaml:4: cat 'cat61': must be vonkries, bradford, cat02 or cat16"},
      {"unknown balance", with("balanced: auto\n"),
       "r.yaml:4: balanced 'auto': must be camera, rgb, none, vonkries, bradford, cat02 or cat16"},
      {"balance as a map", with("balanced: {cat: bradford}\n"), "r.yaml:4: balanced: must be a name, not a map"},
      {"anchor", "metamer: 1\ninput: &a {illuminant: D65}\noutput: {illuminant: A}\n",
       "r.yaml:2: anchor: anchors are not allowed in a recipe; write the value out"},
      {"alias", "metamer: 1\ninput: {illuminant: &a D65}\noutput: {illuminant: *a}\n",
       "r.yaml:2: anchor: anchors are not allowed in a recipe; write the value out"},
      {"alias bomb",
       "a: &a [lol, lol]\nb: &b [*a, *a, *a, *a, *a, *a, *a, *a]\nc: &c [*b, *b, *b, *b, *b, *b, *b, *b]\n"
       "d: &d [*c, *c, *c, *c, *c, *c, *c, *c]\nmetamer: *d\n",
       "r.yaml:1: anchor: anchors are not allowed in a recipe; write the value out"},
      {"tag", with("name: !!binary aGVsbG8=\n"),
       "r.yaml:4: tag 'tag:yaml.org,2002:binary': tags are not allowed in a recipe; leave it out"},
      {"second document", with("---\nmetamer: 1\n"),
       "r.yaml: recipe: holds more than one document; keep one recipe a file"},
      {"tab indentation", "metamer: 1\ninput:\n\tilluminant: D65\n", "r.yaml:3: YAML: illegal map value"},
      {"open bracket", "metamer: 1\ninput: {illuminant: D65\n", "r.yaml:3: YAML: end of map flow not found"},
      {"open quote", "metamer: 1\nname: \"a\n",
       "r.yaml:1: input: is missing; give the light, such as 'input: {illuminant: D65}'"},
      {"UTF-16", std::string("\xFF\xFEm\0", 4), "r.yaml: text encoding 'UTF-16': save the file as UTF-8"},
      {"NUL", std::string("metamer: 1\n\0", 12),
       "r.yaml: text encoding: byte 12 is NUL: UTF-16 or not text; save the file as UTF-8"},
      {"deep list", "metamer: 1\nname: " + repeated("[", 100'000), "r.yaml:2: key: a key must be a plain word"},
      {"deep map", "metamer: 1\nname: " + repeated("{a: ", 100'000),
       "r.yaml:2: nested deeper than 16 levels; this is no recipe"},
      {"deep block list", repeated("- ", 100'000), "r.yaml:1: nested deeper than 16 levels; this is no recipe"},
      {"deep keys", repeated("? ", 100'000), "r.yaml:1: key: a key must be a plain word"},
      {"too large", with("#" + repeated("x", 2'000'000)),
       "r.yaml: size '2000063': is more than a recipe may have (1048576 bytes)"},
  };
  for (const Case& c : cases) {
    const std::string error = errorOf([&] { parse(c.text); });
    EXPECT_EQ(error.substr(0, 6), "r.yaml") << c.name << ": " << error;
    EXPECT_NE(error.find(c.error), std::string::npos) << c.name << ": " << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << c.name << ": " << error;
  }
}

TEST(RecipeTest, NumbersDoNotDependOnTheLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  // Where no locale with a decimal comma is installed, the plain one still has to pass.
  for (const char* const name : {"de_DE.UTF-8", "fr_FR.UTF-8", "C"}) {
    if (std::setlocale(LC_ALL, name) != nullptr) {
      break;
    }
  }
  const Recipe recipe = parse(std::string(kShortest) + "scene: {kind: skin, strength: 0.5}\n");
  const std::string text = toYaml(recipe);
  std::setlocale(LC_ALL, before.c_str());
  EXPECT_EQ(recipe.scene.strength, 0.5);
  EXPECT_NE(text.find("strength: 0.5, fade: 2.5}"), std::string::npos);
}

TEST_F(RecipeFileTest, FilesAreBesideTheRecipe) {
  write("gel.csv", "400,0.5\n700,0.5\n");
  write("lamp.csv", "380,1\n780,3\n");
  const Recipe recipe = readRecipe(
      write("r.yaml", "metamer: 1\ninput: {illuminant: lamp.csv}\noutput: {illuminant: D65, filters: [gel.csv]}\n"));
  EXPECT_EQ(recipe.folder, m_folder);
  const TransformSpec spec = resolve(recipe, testLibrary());
  EXPECT_EQ(spec.input.illuminant.at(580), 2.0);
  ASSERT_EQ(spec.output.filters.size(), 1U);
  EXPECT_EQ(spec.output.filters[0].transmittance.at(500), 0.5);
}

TEST_F(RecipeFileTest, RefusesFilesThatCannotBeRead) {
  const std::string missing = (m_folder / "none.yaml").string();
  EXPECT_EQ(errorOf([&] { readRecipe(missing); }), missing + ": no such file");
  EXPECT_EQ(errorOf([&] { readRecipe(m_folder); }), m_folder.string() + ": is a folder; give a file");
  const std::filesystem::path large = write("large.yaml", "#" + std::string(2'000'000, 'x'));
  EXPECT_EQ(errorOf([&] { readRecipe(large); }),
            large.string() + ": size '2000001': is more than a recipe may have (1048576 bytes)");
  const std::filesystem::path wrong = write("wrong.yaml", "metamer: 3\n");
  EXPECT_EQ(errorOf([&] { readRecipe(wrong); }).substr(0, wrong.string().size() + 3), wrong.string() + ":1:");
}

TEST(RecipeTest, ResolvesEveryName) {
  const Recipe recipe = parse(
      "metamer: 1\nspace: ACEScct\ninput: {illuminant: D65, filters: [{name: ISO Standard Lens, density: 2}]}\n"
      "output: {illuminant: A, observer: Nikon D5100, adaptation: 1}\n"
      "scene: {kind: skin, strength: 0.5}\ncat: bradford\nbalanced: cat02\nkeep_exposure: true\n");
  const TransformSpec spec = resolve(recipe, testLibrary());
  EXPECT_EQ(spec.space.primaries, testLibrary().colourSpace("ACEScg").linear.primaries);
  EXPECT_EQ(spec.input.illuminant.name(), "D65");
  ASSERT_EQ(spec.input.filters.size(), 1U);
  EXPECT_EQ(spec.input.filters[0].density, 2.0);
  EXPECT_EQ(spec.output.observer.response, spectral::Observer::Response::Camera);
  EXPECT_EQ(spec.adaptation, 1.0);
  EXPECT_EQ(spec.cat, spectral::ChromaticAdaptation::Bradford);
  EXPECT_EQ(spec.balanced, Balance{.cat = spectral::ChromaticAdaptation::Cat02});
  EXPECT_TRUE(spec.keepExposure);
  EXPECT_EQ(spec.scene.kind, ReferenceScene::Kind::Skin);
  EXPECT_EQ(spec.scene.strength, 0.5);
  EXPECT_EQ(spec.scene.fade, kDefaultSkinFade);
  EXPECT_EQ(spec.scene.virtualSkins.size(), 1000U);
  EXPECT_EQ(spec.scene.skins.size(), testLibrary().reflectances("model skins").samples.size());
  // All that was measured, less what two tables have of one paint.
  EXPECT_EQ(spec.training.size(), 356U);
  EXPECT_EQ(spec.scene.samples.size(), spec.training.size());
  for (std::size_t i = 0; i < spec.training.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      ASSERT_GE((spec.training[i] - spec.training[j]).norm(), 0.02 * std::sqrt(spectral::kDomainSize));
    }
  }
  EXPECT_EQ(spec.standardObserver.name, "CIE 1931 2");
  const spectral::RgbSpace other = testLibrary().colourSpace("ACES2065-1").linear;
  EXPECT_EQ(resolve(recipe, testLibrary(), other).space.primaries, other.primaries);
}

TEST(RecipeTest, ScenesResolveToWhatTheyNeed) {
  const auto scene = [](const std::string& text) {
    return resolve(parse(std::string(kShortest) + text), testLibrary()).scene;
  };
  EXPECT_EQ(scene("").kind, ReferenceScene::Kind::Natural);
  EXPECT_EQ(scene("").skins.size(), 100U);
  EXPECT_TRUE(scene("scene: {kind: smooth}\n").samples.empty());
  const ReferenceScene dataset = scene("scene: {kind: dataset, set: skin}\n");
  EXPECT_EQ(dataset.samples.size(), testLibrary().reflectances("skin").samples.size());
  EXPECT_TRUE(dataset.skins.empty());
}

TEST(RecipeTest, UnknownNamesListNearOnes) {
  const auto error = [](Recipe recipe) { return errorOf([&] { resolve(recipe, testLibrary()); }); };
  const auto base = [] { return parse(kShortest); };
  Recipe recipe = base();
  recipe.output.illuminant = "HP11";
  EXPECT_NE(error(recipe).find("output: illuminant 'HP11': unknown; near names: HP1;"), std::string::npos)
      << error(recipe);
  recipe = base();
  recipe.input.filters = {{"ISO Standard Lenz", 1.0}};
  EXPECT_NE(error(recipe).find("near names: ISO Standard Lens"), std::string::npos) << error(recipe);
  recipe = base();
  recipe.space = "ACESgc";
  EXPECT_NE(error(recipe).find("ACEScg; all names"), std::string::npos) << error(recipe);
  recipe = base();
  recipe.scene = {ReferenceScene::Kind::Dataset, "colorcheker", 1.0};
  EXPECT_NE(error(recipe).find("near names: colorchecker"), std::string::npos) << error(recipe);
}

}  // namespace
}  // namespace metamer::sip
