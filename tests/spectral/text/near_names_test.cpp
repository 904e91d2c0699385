// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/near_names.h"

#include <gtest/gtest.h>

namespace metamer::spectral {
namespace {

using Names = std::vector<std::string>;
const Names kKnown{"A", "D50", "D65", "FL1", "FL11", "FL12", "HP1", "ISO 7589 Studio Tungsten"};

TEST(NearNamesTest, NearestFirst) {
  EXPECT_EQ(nearNames("FL111", kKnown), (Names{"FL11", "FL1"}));
  EXPECT_EQ(nearNames("d56", kKnown, 1), Names{"D50"});
}

TEST(NearNamesTest, WithoutRegardToCase) {
  EXPECT_EQ(nearNames("hp2", kKnown), Names{"HP1"});
}

TEST(NearNamesTest, ContainmentAfterMisspellings) {
  EXPECT_EQ(nearNames("tungsten", kKnown), Names{"ISO 7589 Studio Tungsten"});
}

TEST(NearNamesTest, NothingNear) {
  EXPECT_TRUE(nearNames("zirconium", kKnown).empty());
  EXPECT_TRUE(nearNames("", {"abc"}).empty());
  EXPECT_TRUE(nearNames("D65", {}).empty());
}

TEST(NearNamesTest, AtMost) {
  EXPECT_EQ(nearNames("FL", kKnown, 2).size(), 2U);
}

TEST(NearNamesTest, Remedy) {
  EXPECT_EQ(unknownNameRemedy("FL111", kKnown, "lutgen list illuminants"),
            "unknown; near names: FL11, FL1; all names: lutgen list illuminants");
  EXPECT_EQ(unknownNameRemedy("zirconium", kKnown, ""), "unknown");
}

}  // namespace
}  // namespace metamer::spectral
