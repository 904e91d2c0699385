// SPDX-License-Identifier: Apache-2.0
// Additions to the YAML of configs, however it is written, and the refusal of what cannot be added to.
#include "config/config_document.h"

#include <gtest/gtest.h>

#include "spectral/fixture.h"

namespace metamer::ocio {
namespace {

using spectral::errorOf;

constexpr const char* kLooks = "- !<Look>\n  name: ours\n  process_space: lin\n  transform: !<MatrixTransform> {}\n";

std::string withLooks(const std::string& text, const std::string& searchFolder = "") {
  return ConfigDocument(text, "base").with(kLooks, "", searchFolder);
}

/// The text without the lines that `with` has added: `inserted` lines from `line` on (from 0).
std::string without(const std::string& text, std::size_t line, std::size_t inserted) {
  std::string result;
  std::size_t begin = 0;
  for (std::size_t k = 0; begin < text.size(); ++k) {
    const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
    if (k < line || k >= line + inserted) {
      result += text.substr(begin, end - begin);
    }
    begin = end;
  }
  return result;
}

TEST(ConfigDocumentTest, ItemsGoToTheEndOfTheirList) {
  const std::string base =
      "ocio_profile_version: 2.1\n"
      "looks:\n"
      "  - !<Look>\n"
      "    name: theirs\n"
      "    description: |\n"
      "      text\n"
      "\n"
      "      # no comment\n"
      "\n"
      "# on colour spaces\n"
      "colorspaces:\n"
      "  - !<ColorSpace> {name: lin}   # kept\n";
  const std::string result = withLooks(base);
  EXPECT_EQ(without(result, 8, 5), base);
  EXPECT_NE(result.find("      # no comment\n\n  - !<Look>\n    name: ours\n"), std::string::npos) << result;
}

TEST(ConfigDocumentTest, AMissingListIsAddedAtTheEnd) {
  const std::string base = "ocio_profile_version: 2\ncolorspaces:\n  - !<ColorSpace> {name: lin}\n";
  EXPECT_EQ(withLooks(base), base +
                                 "\nlooks:\n  - !<Look>\n    name: ours\n    process_space: lin\n    transform: "
                                 "!<MatrixTransform> {}\n");
  // No line end at the end; an end of the document.
  EXPECT_EQ(withLooks(base.substr(0, base.size() - 1)), withLooks(base));
  const std::string result = withLooks(base + "...\n");
  EXPECT_EQ(result.substr(result.size() - 8), " {}\n...\n");
}

TEST(ConfigDocumentTest, EmptyListsAreFilled) {
  for (const char* list : {"looks:\n", "looks: []\n", "looks: [ ]  # none yet\n", "looks: ~\n"}) {
    const std::string result =
        withLooks("ocio_profile_version: 2\n" + std::string(list) + "colorspaces:\n  - {name: lin}\n");
    EXPECT_NE(result.find("\n  - !<Look>\n    name: ours\n"), std::string::npos) << result;
    EXPECT_EQ(result.find('['), std::string::npos) << result;
  }
}

TEST(ConfigDocumentTest, ListsInBracketsStayInBrackets) {
  const std::string head = "ocio_profile_version: 2\n";
  const std::string ours = "!<Look> {name: ours, process_space: lin, transform: !<MatrixTransform> {}}";
  EXPECT_EQ(withLooks(head + "looks: [!<Look> {name: theirs, x: [1, 2]}]  # all]\nroles: {}\n"),
            head + "looks: [!<Look> {name: theirs, x: [1, 2]}, " + ours + "]  # all]\nroles: {}\n");
  EXPECT_EQ(withLooks(head + "looks: [\n  !<Look> {name: theirs}\n]\n"),
            head + "looks: [\n  !<Look> {name: theirs}\n, " + ours + "]\n");
}

TEST(ConfigDocumentTest, IndentAndLineEndsAreTheirs) {
  const std::string result = withLooks("ocio_profile_version: 2\r\nlooks:\r\n- !<Look> {name: theirs}\r\n");
  EXPECT_NE(result.find("\r\n- !<Look>\r\n  name: ours\r\n"), std::string::npos) << result;
  const std::string indented = withLooks("  ocio_profile_version: 2\n  looks:\n      -\n        name: theirs\n");
  EXPECT_NE(indented.find("\n      - !<Look>\n        name: ours\n"), std::string::npos) << indented;
}

TEST(ConfigDocumentTest, TheSearchPathIsAddedToHoweverItIsWritten) {
  const std::string head = "ocio_profile_version: 2\n";
  const std::string tail = "colorspaces:\n  - {name: lin}\n";
  for (const auto& [before, after] : std::vector<std::pair<std::string, std::string>>{
           {"search_path: a:b\n", "search_path: a:b:luts\n"},
           {"search_path: a  # here\n", "search_path: a:luts  # here\n"},
           {"search_path: \"a:b\"\n", "search_path: \"a:b:luts\"\n"},
           {"search_path: 'a'\n", "search_path: 'a:luts'\n"},
           {"search_path: \"\"\n", "search_path: luts\n"},
           {"search_path:\n", "search_path: luts\n"},
           {"search_path: []\n", "search_path: luts\n"},
           {"search_path:\n  - a\n  - b\n", "search_path:\n  - a\n  - b\n  - luts\n"},
           {"", "search_path: luts\n"},
       }) {
    EXPECT_EQ(ConfigDocument(head + before + tail, "base").with("", "", "luts"), head + after + tail);
  }
}

TEST(ConfigDocumentTest, NothingAddedIsTheSameText) {
  for (const char* base :
       {"ocio_profile_version: 2", "# x\nocio_profile_version: 2.1\n\n\n", "{ocio_profile_version: 2}"}) {
    if (base[0] != '{') {
      EXPECT_EQ(ConfigDocument(base, "base").with("", "", ""), base);
    }
  }
}

TEST(ConfigDocumentTest, FactsAreReadWhateverTheProfile) {
  const ConfigDocument document(
      "ocio_profile_version: 9.3\n"
      "family_separator: '>'\n"
      "search_path: [a, b]\n"
      "roles: {aces_interchange: AP0, Scene_Linear: lin}\n"
      "colorspaces:\n"
      "  - !<ColorSpace> {name: AP0, aliases: [Lin_AP0]}\n"
      "  - !<ColorSpace> {name: lin, to_scene_reference: !<GroupTransform> {children: [!<FileTransform> {src: "
      "x.spi1d}]}}\n"
      "  - !<ColorSpace> {name: raw, isdata: true}\n"
      "named_transforms:\n"
      "  - !<NamedTransform> {name: Curve, aliases: [crv]}\n"
      "looks:\n"
      "  - !<Look> {name: Warm}\n",
      "base");
  const ConfigFacts& facts = document.facts();
  EXPECT_EQ(facts.majorVersion, 9);
  EXPECT_EQ(facts.minorVersion, 3);
  EXPECT_EQ(facts.familySeparator, '>');
  EXPECT_EQ(facts.searchPath, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(facts.space("lin_ap0"), "AP0");
  EXPECT_EQ(facts.space("SCENE_LINEAR"), "lin");
  EXPECT_FALSE(facts.space("Warm"));
  EXPECT_EQ(facts.files, std::vector<std::string>{"x.spi1d"});
  EXPECT_EQ(facts.dataSpaces.count("raw"), 1U);
  EXPECT_EQ(facts.looks.count("warm"), 1U);
  for (const char* taken : {"ap0", "lin_ap0", "curve", "crv", "aces_interchange"}) {
    EXPECT_EQ(facts.taken.count(taken), 1U) << taken;
  }
}

TEST(ConfigDocumentTest, WhatIsNoConfigIsRefused) {
  const auto error = [](const std::string& text) { return errorOf([&] { ConfigDocument(text, "base.ocio"); }); };
  EXPECT_NE(error("ocio_profile_version: [\n").find("base.ocio:"), std::string::npos);
  EXPECT_NE(error("just text").find("is no OCIO config"), std::string::npos);
  EXPECT_NE(error("a: 1").find("ocio_profile_version"), std::string::npos);
  EXPECT_NE(error("ocio_profile_version: two").find("'two'"), std::string::npos);
  EXPECT_NE(error("ocio_profile_version: 2.x").find("'2.x'"), std::string::npos);
  // Aliases that blow up, and aliases without an end.
  std::string bomb = "ocio_profile_version: 2\na0: &a0 [x,x,x,x,x,x,x,x,x,x]\n";
  for (int k = 1; k < 9; ++k) {
    const std::string before = "*a" + std::to_string(k - 1);
    bomb += "a" + std::to_string(k) + ": &a" + std::to_string(k) + " [";
    for (int i = 0; i < 10; ++i) {
      bomb += (i > 0 ? "," : "") + before;
    }
    bomb += "]\n";
  }
  EXPECT_NE(error(bomb).find("too large"), std::string::npos);
}

TEST(ConfigDocumentTest, WhatCannotBeAddedToIsRefused) {
  const auto error = [](const std::string& text) { return errorOf([&] { withLooks(text, "luts"); }); };
  EXPECT_NE(error("ocio_profile_version: 2\nlooks: {theirs: x}\n").find("base:2: looks"), std::string::npos);
  EXPECT_NE(error("{ocio_profile_version: 2}").find("written in braces"), std::string::npos);
  EXPECT_NE(error("ocio_profile_version: 2\nsearch_path:\n  a\nlooks:\n").find("base:2: search_path"),
            std::string::npos);
  // Text that would take the addition in.
  EXPECT_NE(error("ocio_profile_version: 2\ndescription: |+\n  text\n\n\n").find("cannot be added to"),
            std::string::npos);
}

}  // namespace
}  // namespace metamer::ocio
