// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/working_space.h"

#include <gtest/gtest.h>

#include <array>
#include <sstream>

#include "metamer/ocio/bake.h"
#include "metamer/ocio/pixel_processor.h"
#include "sip/sip_fixture.h"

namespace metamer::ocio {
namespace {

using spectral::errorOf;
using spectral::testLibrary;

/// A studio's config: its linear space has half the gain of ACES2065-1, its log space is a logarithm of that.
OCIO::ConstConfigRcPtr studioConfig(bool hasInterchange = true) {
  std::istringstream text(std::string(R"(ocio_profile_version: 2
roles: {default: studio linear, scene_linear: studio linear)") +
                          (hasInterchange ? ", aces_interchange: aces" : "") + R"(}
displays:
  screen:
    - !<View> {name: raw, colorspace: studio linear}
colorspaces:
  - !<ColorSpace> {name: aces, encoding: scene-linear}
  - !<ColorSpace>
    name: studio linear
    aliases: [sl]
    encoding: scene-linear
    to_reference: !<MatrixTransform> {matrix: [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1]}
  - !<ColorSpace>
    name: studio log
    encoding: log
    to_reference: !<LogAffineTransform> {log_side_slope: [0.06, 0.06, 0.06], log_side_offset: [0.6, 0.6, 0.6], lin_side_offset: [0.001, 0.001, 0.001], direction: inverse}
  - !<ColorSpace>
    name: studio video
    encoding: sdr-video
    to_reference: !<ExponentTransform> {value: [2.2, 2.2, 2.2, 1]}
  - !<ColorSpace> {name: masks, isdata: true}
)");
  return OCIO::Config::CreateFromStream(text);
}

sip::Recipe recipeIn(const std::string& space) {
  sip::Recipe recipe;
  recipe.space = space;
  recipe.input.illuminant = "D65";
  recipe.output.illuminant = "A";
  // What a space does to a transform does not depend on the scene; this one takes half the time.
  recipe.scene.kind = sip::ReferenceScene::Kind::Smooth;
  return recipe;
}

std::array<float, 4> through(const OCIO::ConstTransformRcPtr& transform, std::array<float, 4> pixel) {
  PixelProcessor(transform).apply(pixel);
  return pixel;
}

TEST(WorkingSpaceTest, BuiltInSpaces) {
  const WorkingSpace linear = findWorkingSpace("acescg", testLibrary(), nullptr);
  EXPECT_EQ(linear.name, "ACEScg");
  EXPECT_TRUE(linear.isLinear);
  EXPECT_FALSE(linear.toEngine);
  const WorkingSpace log = findWorkingSpace("ACEScct", testLibrary(), nullptr);
  EXPECT_TRUE(log.isLog);
  EXPECT_EQ(log.engine.name, "ACEScg");
  ASSERT_TRUE(log.toEngine);
  EXPECT_NEAR(through(log.toEngine, {0.4135884F, 0, 0, 1})[0], 0.18, 1e-6);
}

TEST(WorkingSpaceTest, SpacesOfAConfig) {
  const auto config = studioConfig();
  const WorkingSpace linear = findWorkingSpace("sl", testLibrary(), config);
  EXPECT_EQ(linear.name, "studio linear");
  EXPECT_EQ(linear.engine.name, "ACES2065-1");
  EXPECT_TRUE(linear.isLinear);
  EXPECT_EQ(through(linear.toEngine, {0.25F, 0.5F, 1.0F, 1.0F})[1], 1.0F);
  const WorkingSpace log = findWorkingSpace("studio log", testLibrary(), config);
  EXPECT_TRUE(log.isLog);
  EXPECT_FALSE(log.isLinear);
  const WorkingSpace video = findWorkingSpace("studio video", testLibrary(), config);
  EXPECT_FALSE(video.isLog || video.isLinear);
  // A built-in name keeps its meaning whatever the config holds.
  EXPECT_EQ(findWorkingSpace("ACEScg", testLibrary(), config).engine.name, "ACEScg");
}

TEST(WorkingSpaceTest, RefusesWhatHasNoColours) {
  EXPECT_NE(errorOf([] { findWorkingSpace("ACEScgg", testLibrary(), nullptr); }).find("ACEScg"), std::string::npos);
  EXPECT_NE(errorOf([] { findWorkingSpace("studio lin", testLibrary(), studioConfig()); }).find("studio linear"),
            std::string::npos);
  EXPECT_NE(errorOf([] { findWorkingSpace("masks", testLibrary(), studioConfig()); }).find("holds data"),
            std::string::npos);
  EXPECT_NE(errorOf([] { findWorkingSpace("sl", testLibrary(), studioConfig(false)); }).find("aces_interchange"),
            std::string::npos);
}

// The same look in a space of a config and in the engine's own gives the same light, but for the tables' errors.
TEST(WorkingSpaceTest, ALookInAConfigsSpace) {
  const auto config = studioConfig();
  const Baked own = bake(recipeIn("ACES2065-1"), testLibrary());
  for (const char* name : {"studio linear", "studio log", "studio video"}) {
    const Baked baked =
        bake(recipeIn(name), testLibrary(), {.representation = {}, .size = 0, .shaper = {}, .config = config});
    // A log or a video curve holds nothing below zero, where a few of the probes next to the locus end up.
    const bool holdsNegatives = name == std::string("studio linear");
    EXPECT_LE(baked.certificate.error.p99, holdsNegatives ? 1.0 : 7.0) << name;
    const WorkingSpace space = findWorkingSpace(name, testLibrary(), config);
    const std::array<float, 4> light = {0.2F, 0.3F, 0.15F, 1.0F};
    const auto expected = through(own.group, light);
    const auto found = through(space.toEngine, through(baked.group, through(space.fromEngine, light)));
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(found[k], expected[k], 1e-5) << name;
    }
  }
}

}  // namespace
}  // namespace metamer::ocio
