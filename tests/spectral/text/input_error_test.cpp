// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/input_error.h"

#include <gtest/gtest.h>

#include <string>

namespace metamer::spectral {
namespace {

std::string text(const std::string& where, const std::string& field, const std::string& value,
                 const std::string& remedy) {
  return InputError(where, field, value, remedy).what();
}

TEST(InputErrorTest, NamesPlaceFieldValueAndRemedy) {
  EXPECT_EQ(text("gel.csv:12", "value", "0,5", "use a point"), "gel.csv:12: value '0,5': use a point");
}

TEST(InputErrorTest, LeavesOutWhatDoesNotApply) {
  EXPECT_EQ(text("", "cat", "x", "unknown"), "cat 'x': unknown");
  EXPECT_EQ(text("gel.csv", "", "", "no such file"), "gel.csv: no such file");
  EXPECT_EQ(text("gel.csv", "rows", "", "none"), "gel.csv: rows: none");
}

TEST(InputErrorTest, StaysOnOneLine) {
  EXPECT_EQ(text("a\nb", "f", "x\ry\tz", "r\n"), "a b: f 'x y z': r ");
}

TEST(InputErrorTest, ShortensTheValueBetweenCharacters) {
  const std::string message = text("", "f", std::string(1000, 'x'), "r");
  EXPECT_EQ(message, "f '" + std::string(57, 'x') + "...': r");
  // 56 letters and a two-byte character across the cut: the character goes as a whole.
  EXPECT_EQ(text("", "f", std::string(56, 'x') + "\u00e9\u00e9\u00e9\u00e9", "r"),
            "f '" + std::string(56, 'x') + "...': r");
}

}  // namespace
}  // namespace metamer::spectral
