// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/message_line.h"

#include <gtest/gtest.h>

namespace metamer::spectral {
namespace {

TEST(MessageLineTest, IsOneLineWithoutTheBuildersFolders) {
  EXPECT_EQ(messageLine("Error reading\n  \tfile:\r\n x  "), "Error reading file: x");
  EXPECT_EQ(messageLine("failed at /build/oiio-2.4/src/libutil/plugin.cpp:215, in open"), "failed at in open");
  EXPECT_EQ(messageLine("(../src/lib/Iex/IexBaseExc.h:12) no header"), "no header");
  // Files of the user stay.
  EXPECT_EQ(messageLine("/show/luts/night.cube: size '1': too small"), "/show/luts/night.cube: size '1': too small");
  EXPECT_EQ(messageLine("main.cpp: is no recipe"), "main.cpp: is no recipe");
  EXPECT_EQ(messageLine("grades/warm.cc: LUT: cannot be read"), "grades/warm.cc: LUT: cannot be read");
  EXPECT_EQ(messageLine(""), "");
}

TEST(MessageLineTest, LosesItsMiddleWhereItIsTooLong) {
  const std::string line = messageLine("start " + std::string(1000, 'x') + " end");
  EXPECT_EQ(line.size(), kLongestMessage);
  EXPECT_EQ(line.rfind("start x", 0), 0U);
  EXPECT_EQ(line.substr(line.size() - 6), "xx end");
  EXPECT_NE(line.find("x ... x"), std::string::npos);
  // Characters stay whole.
  for (std::size_t most = 40; most < 50; ++most) {
    std::string text;
    for (int k = 0; k < 60; ++k) {
      text += "\u00e9";
    }
    const std::string cut = messageLine(text, most);
    EXPECT_LE(cut.size(), most);
    const std::size_t mark = cut.find(" ... ");
    ASSERT_NE(mark, std::string::npos);
    EXPECT_EQ(mark % 2, 0U);
    EXPECT_EQ((cut.size() - mark - 5) % 2, 0U);
  }
}

}  // namespace
}  // namespace metamer::spectral
