// SPDX-License-Identifier: Apache-2.0
#include "config/short_tables.h"

#include <gtest/gtest.h>

namespace metamer::ocio {
namespace {

TEST(ShortTablesTest, NumbersOfTablesAreRounded) {
  EXPECT_EQ(shortTables("    <LUT3D>\n        <Array dim=\"2 2 2 3\">\n"
                        "  0.123456789 -0.5         1\n"
                        " -4.68791680  1e-07 -1e-07\n"
                        "        </Array>\n    </LUT3D>\n"),
            "    <LUT3D>\n        <Array dim=\"2 2 2 3\">\n"
            ".12346 -.5 1\n"
            "-4.68792 0 0\n"
            "        </Array>\n    </LUT3D>\n");
}

TEST(ShortTablesTest, EverythingElseStays) {
  const std::string matrix =
      "<Matrix>\n  <Array dim=\"3 3\">\n 0.0236992333    1 2\n  </Array>\n</Matrix>\n<Description>1  2  "
      "3</Description>\n";
  EXPECT_EQ(shortTables(matrix), matrix);
  EXPECT_EQ(shortTables("<LUT1D>\n<IndexMap>0  1</IndexMap>\n0.1234567\n</LUT1D>\n" + matrix),
            "<LUT1D>\n<IndexMap>0  1</IndexMap>\n0.1234567\n</LUT1D>\n" + matrix);
  // What is no row of numbers is left alone, in a table too.
  const std::string odd = "<LUT3D>\n<Array>\n0.1234567 x\n</Array>\n</LUT3D>\n";
  EXPECT_EQ(shortTables(odd), odd);
  EXPECT_EQ(shortTables(""), "");
}

}  // namespace
}  // namespace metamer::ocio
