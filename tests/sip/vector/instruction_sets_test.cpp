// SPDX-License-Identifier: Apache-2.0
#include "vector/instruction_sets.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "metamer/sip/homogeneous_map.h"
#include "sip/sip_fixture.h"

namespace metamer::sip {
namespace {

/// Sets it back, so that no other test runs on less than there is.
class InstructionSetsTest : public testing::Test {
 protected:
  ~InstructionSetsTest() override { allowInstructionSets(0); }
};

TEST_F(InstructionSetsTest, WhatIsNotAllowedIsNotTold) {
  const std::int64_t all = instructionSets();
  allowInstructionSets(std::int64_t{1} << 60);  // none of x86 or Arm
  const std::int64_t fewest = instructionSets();
  EXPECT_EQ(fewest & all, fewest);
  EXPECT_NE(fewest, 0) << "a portable fallback is always there";
  allowInstructionSets(all);
  EXPECT_EQ(instructionSets(), all);
  allowInstructionSets(0);
  EXPECT_EQ(instructionSets(), all);
}

// The map's promise: the same float32 operations whatever the machine has.
TEST_F(InstructionSetsTest, EachGivesTheSameBits) {
  const HomogeneousMap map = buildHomogeneousMap(SpectralTransform(specOf("D65", "A")), 0.3);
  std::vector<float> pixels;
  for (int i = 0; i < 4 * 1021; ++i) {
    pixels.push_back(std::ldexp(static_cast<float>(std::sin(0.7 * i) + 0.8), i % 13 - 6));
  }
  std::vector<float> expected(pixels.size());
  map.apply(pixels, expected);
  const std::int64_t all = instructionSets();
  int count = 0;
  for (int bit = 0; bit < 63; ++bit) {
    if ((all >> bit & 1) == 0) {
      continue;
    }
    ++count;
    allowInstructionSets(std::int64_t{1} << bit);
    std::vector<float> result(pixels.size());
    map.apply(pixels, result);
    for (std::size_t i = 0; i < result.size(); ++i) {
      ASSERT_EQ(std::bit_cast<std::uint32_t>(result[i]), std::bit_cast<std::uint32_t>(expected[i]))
          << "set " << bit << ", float " << i;
    }
  }
  EXPECT_GE(count, 1);
}

// The engine's too, for colours with clamped bands in any company.
TEST_F(InstructionSetsTest, EachSolvesToTheSameBits) {
  const SpectralTransform transform(naturalSpecOf("HP1", "D65"), 81);
  std::vector<Eigen::Vector3d> given;
  for (int i = 0; i < 101; ++i) {
    given.emplace_back(std::sin(0.7 * i) + 0.9, std::sin(1.9 * i) + 0.9, std::sin(3.1 * i) + 0.9);
  }
  std::vector<Eigen::Vector3d> expected;
  for (const Eigen::Vector3d& colour : given) {
    expected.push_back(transform.apply(colour));
  }
  const std::int64_t all = instructionSets();
  for (int bit = 0; bit < 63; ++bit) {
    if ((all >> bit & 1) == 0) {
      continue;
    }
    allowInstructionSets(std::int64_t{1} << bit);
    std::vector<Eigen::Vector3d> result = given;
    transform.apply(result);
    for (std::size_t i = 0; i < result.size(); ++i) {
      ASSERT_EQ(result[i], expected[i]) << "set " << bit << ", colour " << i;
    }
  }
}

}  // namespace
}  // namespace metamer::sip
