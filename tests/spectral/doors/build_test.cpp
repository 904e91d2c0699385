// SPDX-License-Identifier: Apache-2.0
// How everything is built.
#include <gtest/gtest.h>

#include <Eigen/Core>

namespace metamer::spectral {
namespace {

TEST(BuildTest, SumsDoNotDependOnTheProcessorsCaches) {
  EXPECT_EQ(Eigen::l1CacheSize(), 48 * 1024);
  EXPECT_EQ(Eigen::l2CacheSize(), 2 * 1024 * 1024);
  EXPECT_EQ(Eigen::l3CacheSize(), 32 * 1024 * 1024);
}

}  // namespace
}  // namespace metamer::spectral
