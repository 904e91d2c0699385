// SPDX-License-Identifier: Apache-2.0
// Every public function of ocio_plugin that has a range, with arguments just outside it and just inside.
#include <gtest/gtest.h>

#include <functional>

#include "metamer/ocio/bake.h"
#include "metamer/ocio/compared_transform.h"
#include "metamer/ocio/config_source.h"
#include "metamer/ocio/config_writer.h"
#include "metamer/ocio/exposure_invariant_chain.h"
#include "metamer/ocio/log_cube.h"
#include "metamer/ocio/lut_writer.h"
#include "metamer/ocio/pixel_processor.h"
#include "metamer/ocio/representation.h"
#include "metamer/ocio/shaper.h"
#include "metamer/ocio/working_space.h"
#include "metamer/sip/band_weights.h"
#include "metamer/sip/recipe.h"
#include "sip/sip_fixture.h"
#include "spectral/refusals.h"
#include "spectral/temporary_folder.h"

namespace metamer::ocio {
namespace {

using spectral::testLibrary;

sip::Recipe recipe() {
  sip::Recipe recipe;
  recipe.input.illuminant = "D65";
  recipe.output.illuminant = "A";
  recipe.scene.kind = sip::ReferenceScene::Kind::Smooth;
  return recipe;
}

const sip::SpectralTransform& transform() {
  static const sip::SpectralTransform transform(sip::specOf("D65", "A"), sip::kMinimumBandCount);
  return transform;
}

OCIO::GroupTransformRcPtr nothing() {
  return OCIO::GroupTransform::Create();
}

TEST(OcioRanges, Tables) {
  const Signal same{OCIO::MatrixTransform::Create(), OCIO::MatrixTransform::Create()};
  for (const int size : {-1, 0, kSmallestTable - 1, kLargestTable + 1}) {
    const std::string said = "size '" + std::to_string(size) + "': must be from 3 to 129";
    EXPECT_REFUSED(said, exposureInvariantChain(sip::specOf("D65", "A"), transform(), {.size = size}));
    EXPECT_REFUSED(said, logCube(transform(), same, {.size = size}));
    EXPECT_REFUSED(said,
                   engineOperators(Representation::ExposureInvariantChain, sip::specOf("D65", "A"), transform(), size));
    EXPECT_REFUSED(said, lutText(lutFormatNamed("iridas_cube"), nothing(), size, {}));
  }
  EXPECT_TAKEN(logCube(transform(), same, {.size = kSmallestTable, .fitted = false}));
  EXPECT_TAKEN(lutText(lutFormatNamed("iridas_cube"), nothing(), kSmallestTable, {}));
  EXPECT_TAKEN(lutText(lutFormatNamed("iridas_cube"), nothing(), kLargestTable, {}));
  EXPECT_REFUSED("lowest stop '-25'", logCube(transform(), same, {.size = kSmallestTable, .lowestStop = -25}));
  EXPECT_REFUSED("highest stop '25'", logCube(transform(), same, {.size = kSmallestTable, .highestStop = 25}));
  EXPECT_REFUSED("lowest stop '8'", logCube(transform(), same, {.size = kSmallestTable, .lowestStop = 8}));
  EXPECT_REFUSED("representation 'log cube'",
                 engineOperators(Representation::LogCube, sip::specOf("D65", "A"), transform(), kSmallestTable));
}

TEST(OcioRanges, Curves) {
  for (const int entries : {-1, 1, kMostCurveEntries + 1}) {
    const std::string said = "shaper size '" + std::to_string(entries) + "': must be from 2 to 65536";
    EXPECT_REFUSED(said, lutText(lutFormatNamed("spi1d"), nothing(), 0, {}, entries));
    EXPECT_REFUSED(said, bake(recipe(), testLibrary(), {.shaperSize = entries}));
  }
  EXPECT_TAKEN(lutText(lutFormatNamed("spi1d"), nothing(), 0, {}, kFewestCurveEntries));
}

TEST(OcioRanges, Bakes) {
  const auto baked = [](const BakeOptions& options) { return bake(recipe(), testLibrary(), options); };
  EXPECT_TAKEN(baked({.size = kSmallestTable, .lowestStop = 0, .highestStop = 0}));
  EXPECT_REFUSED("size '2'", baked({.size = 2}));
  EXPECT_REFUSED("size '130'", baked({.size = 130}));
  EXPECT_REFUSED("tolerance", baked({.tolerance = 0.0}));
  EXPECT_REFUSED("tolerance", baked({.representation = Representation::Matrix, .tolerance = 1.0}));
  EXPECT_REFUSED("stops '1:0'", baked({.lowestStop = 1, .highestStop = 0}));
  EXPECT_REFUSED("stops '-25:0'", baked({.lowestStop = -25, .highestStop = 0}));
  EXPECT_REFUSED("stops '0:25'", baked({.lowestStop = 0, .highestStop = 25}));
  EXPECT_REFUSED("format", bakeText(recipe(), testLibrary(), "cubes"));
  EXPECT_REFUSED("output", bakeFile(recipe(), testLibrary(), "/nonexistent/a.cube"));
  EXPECT_REFUSED("extension", bakeFile(recipe(), testLibrary(), "/nonexistent/a.cubes"));
  EXPECT_REFUSED("LUT files '0'", convertedLuts({}, lutFormatNamed("iridas_cube"), 0, 0));
  EXPECT_REFUSED("LUT", convertedLuts({"/nonexistent/a.cube"}, lutFormatNamed("iridas_cube"), 0, 0));
}

TEST(OcioRanges, Pixels) {
  std::vector<float> pixels(7, 0.5F);
  const PixelProcessor processor(nothing());
  EXPECT_TAKEN((processor.apply(std::span(pixels.data(), 4)), 0));
  EXPECT_REFUSED("pixels '7'", (processor.apply(pixels), 0));
  EXPECT_REFUSED("no such file", PixelProcessor::fromFile("/nonexistent/a.cube"));
}

TEST(OcioRanges, Names) {
  EXPECT_REFUSED("shapers", shaperFromName("ACEScce"));
  EXPECT_REFUSED("space", findWorkingSpace("ACEScf", testLibrary(), {}));
  EXPECT_REFUSED("none.ocio", configNamed("/nonexistent/none.ocio"));
  EXPECT_REFUSED("none.cube", comparedFile("/nonexistent/none.cube", {}, testLibrary(), {}));
  EXPECT_REFUSED("none.ocio", comparedLook("/nonexistent/none.ocio", "look", testLibrary()));
}

TEST(OcioRanges, Configs) {
  const TemporaryFolder folder;
  const auto with = [&](const std::function<void(ConfigOptions&)>& change) {
    ConfigOptions options;
    change(options);
    return writeConfig({recipe()}, testLibrary(), folder / "c.ocio", options);
  };
  EXPECT_REFUSED("size '2'", with([](auto& options) { options.size = 2; }));
  EXPECT_REFUSED("size '130'", with([](auto& options) { options.size = 130; }));
  EXPECT_REFUSED("tolerance '0'", with([](auto& options) { options.tolerance = 0.0; }));
  EXPECT_REFUSED("LUT folder", with([](auto& options) { options.lutFolder = "a/b"; }));
  EXPECT_REFUSED("base", with([](auto& options) { options.base = "/nonexistent/base.ocio"; }));
}

}  // namespace
}  // namespace metamer::ocio
