// SPDX-License-Identifier: Apache-2.0
// Lists of numbers are read apart from the rest of a document. The tree, or the complaint, is that of reading it whole.
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/yaml_tree.h"

namespace metamer::spectral {
namespace {

void write(const YamlNode& node, std::string& out) {
  out += node.kindName() + "@" + std::to_string(node.line) + ":" + std::to_string(node.column) +
         (node.quoted ? "'" : "=") + node.text + "(";
  for (const YamlNode& item : node.items) {
    write(item, out);
  }
  for (const YamlMember& member : node.members) {
    out += member.key + "@" + std::to_string(member.line) + ":" + std::to_string(member.column) + " ";
    write(member.value, out);
  }
  out += ")";
}

std::string treeOf(const std::string& document) {
  std::string out;
  try {
    write(parseYaml(document, "scene.yaml", {.name = "scene", .deepest = 6, .mostNodes = 60, .saysColumns = true}),
          out);
  } catch (const InputError& error) {
    out = error.what();
  }
  return out;
}

/// The character that stands for a list is in the document itself: it is read whole.
std::string treeOfWhole(const std::string& document) {
  return treeOf("# \xEE\x80\x80\n" + document);
}

void expectAsWhole(const std::string& document) {
  EXPECT_EQ(treeOf("# !\n" + document), treeOfWhole(document)) << document;
}

TEST(NumberLists, AreThoseOfTheParser) {
  expectAsWhole("a: [1, 2.5, -3e-2, +.5, 4.]\nb: {c: [1,2,3], d: [4, 5,\n   6], e: x}\nf: [[0, 0, 1], [7, 8, 9]] \n");
  expectAsWhole("- [1, 2, 3]\n- {a: [1, 2, 3], b: [4, 5, 6], c: d}\n- [ 1 ,\n\n 2, 3 ]\n- e\n");
  expectAsWhole("[1, 2, 3]");
  EXPECT_EQ(parseYaml("a: [1, 2, 3]", "scene.yaml").find("a")->items.at(2).text, "3");
}

TEST(NumberLists, OfOtherKindsAreText) {
  expectAsWhole("# [1, 2, 3]\na: b  # [1,\n# 2, 3]\nc: d\n");
  expectAsWhole("# [1,\n2, 3]: d\n");
  expectAsWhole("a: '[1, 2, 3]'\nb: \"[1, 2, 3]\"\nc: x [1, 2, 3]\nd: [1, 2, 3]x\n");
  expectAsWhole("a: |\n  [1, 2, 3]\nb: >-\n  [1, 2, 3]\nc: |-\n  [1, 2, 3]\n");
  expectAsWhole("a: b\n  [1, 2, 3]\n");
  expectAsWhole("a: [1, 2, 3]\n  b\n");
  expectAsWhole("{[1, 2, 3]: a}");
  expectAsWhole("[1, 2, 3]: a");
  expectAsWhole("? [1, 2, 3]\n: a\n");
  expectAsWhole("a: &b [1, 2, 3]\nc: *b\n");
  expectAsWhole("a: !x [1, 2, 3]\n");
  expectAsWhole("a: [1, 2, 3]\n---\nb: [1, 2, 3]\n");
  expectAsWhole("a: [1,\n..., 2, 3]\n");
  expectAsWhole("a: [1, 2, 3,]\nb: [1, , 3]\n");
  expectAsWhole("a: [1, 2, 3");
  expectAsWhole("a: [1, 2, 3}\n");
  expectAsWhole("a: [1,\r\n 2, 3]\r\nb: [1, 2, 3]\r\n");
  expectAsWhole("%YAML 1.2 [1, 2, 3]\n---\na: b\n");
  expectAsWhole("a: {b: {c: {d: {e: [1, 2, 3]}}}}\n");
  expectAsWhole("a: {b: {c: {d: {e: {f: [1, 2, 3]}}}}}\n");
  std::string many = "a: [0";
  for (int k = 1; k < 60; ++k) {
    many += ", " + std::to_string(k);
  }
  expectAsWhole(many + "]\n");
}

TEST(NumberLists, OfAnyDocumentAreThoseOfTheParser) {
  constexpr const char* kPieces[] = {"[1, 2, 3]", "[4,\n   5, 6]",
                                     "a: ",       "- ",
                                     "b",         "\n",
                                     "\n  ",      ", ",
                                     "{",         "}",
                                     "[",         "]",
                                     ": ",        "# ",
                                     "'",         "\"",
                                     "| ",        "? ",
                                     "é"};
  std::mt19937 random(4);
  for (int turn = 0; turn < 20000; ++turn) {
    std::string document;
    const auto length = 1 + random() % 9;
    for (unsigned k = 0; k < length; ++k) {
      document += kPieces[random() % std::size(kPieces)];
    }
    expectAsWhole(document);
    ASSERT_FALSE(HasFailure());
  }
}

}  // namespace
}  // namespace metamer::spectral
