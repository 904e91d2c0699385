// SPDX-License-Identifier: Apache-2.0
#include "files/operators_text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

namespace metamer::ocio {
namespace {

/// Entries of every width that a number has, and of either sign.
OCIO::Lut3DTransformRcPtr tableOf(unsigned long size) {
  auto table = OCIO::Lut3DTransform::Create(size);
  for (unsigned long node = 0; node < size * size * size; ++node) {
    const auto at = static_cast<float>(node);
    const float small = std::ldexp(std::sin(at), -static_cast<int>(node % 40));
    table->setValue(node / size / size, node / size % size, node % size, at / 3.0F, small, -1e6F * small);
  }
  return table;
}

/// Tables before, within and behind a group, between operators; one is inverted, one has whole numbers.
OCIO::GroupTransformRcPtr manyTables() {
  auto inner = OCIO::GroupTransform::Create();
  inner->appendTransform(tableOf(5));
  inner->appendTransform(OCIO::FixedFunctionTransform::Create(OCIO::FIXED_FUNCTION_RGB_TO_HSV));
  const auto inverted = tableOf(2);
  inverted->setDirection(OCIO::TRANSFORM_DIR_INVERSE);
  inner->appendTransform(inverted);
  auto group = OCIO::GroupTransform::Create();
  group->appendTransform(tableOf(3));
  group->appendTransform(inner);
  const auto whole = tableOf(2);
  whole->setFileOutputBitDepth(OCIO::BIT_DEPTH_UINT10);
  group->appendTransform(whole);
  group->appendTransform(tableOf(9));
  return group;
}

TEST(OperatorsTextTest, IsOpenColorIosToTheByte) {
  for (const char* id : {"an id", ""}) {
    const OCIO::GroupTransformRcPtr group = manyTables();
    group->getFormatMetadata().setID(id);
    std::ostringstream theirs;
    group->write(OCIO::Config::CreateRaw(), "Color Transform Format", theirs);
    EXPECT_EQ(operatorsText(group, "Color Transform Format"), theirs.str());
    // The group is as it was.
    std::ostringstream again;
    group->write(OCIO::Config::CreateRaw(), "Color Transform Format", again);
    EXPECT_EQ(again.str(), theirs.str());
  }
}

TEST(OperatorsTextTest, RefusesWhatTheFormatCannotHold) {
  EXPECT_THROW(operatorsText(manyTables(), "no format"), OCIO::Exception);
}

}  // namespace
}  // namespace metamer::ocio
