// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/text.h"

#include <gtest/gtest.h>

#include <limits>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/spectral_files.h"

namespace metamer::spectral {
namespace {

TEST(TextTest, TrimsBothEndsAlone) {
  EXPECT_EQ(trimmed(" \t a b\r\n\f\v"), "a b");
  EXPECT_EQ(trimmed(" \n "), "");
  EXPECT_EQ(trimmed(""), "");
}

TEST(TextTest, LowersAsciiAlone) {
  EXPECT_EQ(lowerCase("LED-\xC3\x84 z9"), "led-\xC3\x84 z9");
}

TEST(TextTest, KeepsMessagesOnOneLine) {
  EXPECT_EQ(oneLine("a\nb\tc\x7F"
                    "d\xC3\xA9"),
            "a b c d\xC3\xA9");
}

TEST(TextTest, NumbersReadBackAsThemselves) {
  for (const double value :
       {0.1, 1.0 / 3.0, 6.02214076e23, 5e-324, -0.0, 1e21, 400.0, std::numeric_limits<double>::max()}) {
    EXPECT_EQ(parseNumber(shortestNumber(value)), value) << shortestNumber(value);
    EXPECT_EQ(parseNumber(numberText(value)), value) << numberText(value);
  }
  EXPECT_EQ(shortestNumber(0.1), "0.1");
  EXPECT_EQ(numberText(400.0), "400");
  EXPECT_EQ(numberText(100000.0), "100000");
}

TEST(TextTest, ThreeDigitsForFigures) {
  EXPECT_EQ(threeDigits(3.14159), "3.14");
  EXPECT_EQ(threeDigits(0.00123456), "0.00123");
}

TEST(TextTest, JoinsWithCommas) {
  EXPECT_EQ(joined({}), "");
  EXPECT_EQ(joined({"a"}), "a");
  EXPECT_EQ(joined({"a", "b"}), "a, b");
}

TEST(TextTest, ParsesWholeTokensInDecimalAlone) {
  EXPECT_EQ(parseNumber("-1.5e3"), -1500.0);
  EXPECT_EQ(parseNumber(" +2\r"), 2.0);
  for (const char* token : {"", "1x", "0x10", "nan", "inf", "1e999", "1 2", "1,5", "--1"}) {
    EXPECT_FALSE(parseNumber(token)) << token;
  }
}

TEST(TextTest, KnowsTheNamesOfWhatIsNoNumber) {
  for (const char* token : {"nan", "-NaN", "inf", "+Infinity", "-INF"}) {
    EXPECT_TRUE(isNotFinite(token)) << token;
  }
  for (const char* token : {"", "info", "1", "nano", "in"}) {
    EXPECT_FALSE(isNotFinite(token)) << token;
  }
}

TEST(TextTest, TellsFilesFromNames) {
  EXPECT_TRUE(hasSpectralExtension("lamp.SPDX"));
  EXPECT_FALSE(hasSpectralExtension("lamp.xml"));
  EXPECT_TRUE(looksLikeSpectralFile("folder/lamp"));
  EXPECT_TRUE(looksLikeSpectralFile("lamp.csv"));
  EXPECT_FALSE(looksLikeSpectralFile("D65"));
}

TEST(TextTest, RefusesWhatIsNotUtf8) {
  EXPECT_EQ(checkedUtf8("\xEF\xBB\xBF"
                        "a",
                        "f"),
            "a");
  for (const std::string& text : {std::string("\xFF\xFE"
                                              "a\0",
                                              4),
                                  std::string("a\0b", 3), std::string("\xC3("), std::string("\xED\xA0\x80")}) {
    EXPECT_THROW(checkedUtf8(text, "f"), InputError);
  }
}

}  // namespace
}  // namespace metamer::spectral
