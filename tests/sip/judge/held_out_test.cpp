// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/held_out.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "sip/sip_fixture.h"

namespace metamer::sip {
namespace {

const HeldOutSet& named(const std::vector<HeldOutSet>& sets, const std::string& name) {
  for (const HeldOutSet& set : sets) {
    if (set.name == name) {
      return set;
    }
  }
  throw std::runtime_error("no set " + name);
}

TEST(HeldOutTest, EverySetIsNearerThanByPlainAdaptation) {
  const auto& library = testLibrary();
  const auto sets = heldOutErrors(naturalSpecOf("D65", "A"), library);
  // All but virtual skins.
  EXPECT_EQ(sets.size() + 1, library.reflectanceSetNames().size());
  for (const HeldOutSet& set : sets) {
    EXPECT_EQ(set.count, library.reflectances(set.name).samples.size());
    EXPECT_LT(set.engine, set.adaptation) << set.name;
    EXPECT_GT(set.engine, 0.1) << set.name << ": a set that is left out is not known";
  }
  // A fit of 18 numbers to some 500 other surfaces: near, but not as if it knew these.
  EXPECT_NEAR(named(sets, "tm30").rootPolynomial, 1.5, 0.5);
}

TEST(HeldOutTest, SmoothLeavesNothingOut) {
  // Without a scene, what is held out changes the limits alone, which ordinary surfaces do not meet.
  const TransformSpec spec = specOf("D65", "A");
  TransformSpec all = spec;
  all.training = naturalSpecOf("D65", "A").training;
  const auto sets = heldOutErrors(all, testLibrary());
  EXPECT_GT(named(sets, "skin").engine, named(heldOutErrors(naturalSpecOf("D65", "A"), testLibrary()), "skin").engine);
}

TEST(HeldOutTest, PairsAreLeftOutToo) {
  const TransformSpec natural = naturalSpecOf("D65", "HP1");
  TransformSpec spec = natural;
  spec.scene.kind = ReferenceScene::Kind::Pairs;
  spec.scene.pairs = samplesOf("colorchecker");
  const auto without = heldOutErrors(natural, testLibrary());
  const auto with = heldOutErrors(spec, testLibrary());
  // Their own set is judged as if there were none; others have them.
  EXPECT_NEAR(named(with, "colorchecker").engine, named(without, "colorchecker").engine, 1e-9);
  EXPECT_GT(std::abs(named(with, "tm30").engine - named(without, "tm30").engine), 1e-4);
}

TEST(HeldOutTest, NothingToJudgeWhereNothingIsDone) {
  EXPECT_TRUE(heldOutErrors(naturalSpecOf("D65", "D65"), testLibrary()).empty());
}

}  // namespace
}  // namespace metamer::sip
