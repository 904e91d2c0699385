// SPDX-License-Identifier: Apache-2.0
// Hosts of every kind: without suites, in another order, with colour management; loading and unloading.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "frame.h"

namespace bare_host {
namespace {

constexpr OfxRectI kBounds = {0, 0, 40, 30};

/// The result of one render in a host of these features.
Frame rendered(const Features& features, const std::map<std::string, Properties::Value>& settings) {
  const Host host(builtLibrary(), features);
  const auto effect = host.create(0, settings);
  Frame source({.bounds = kBounds});
  source.fill(testPixel);
  Frame output({.bounds = kBounds});
  effect->connect("Source", source.image());
  effect->connect("Output", output.image());
  EXPECT_EQ(effect->render(kBounds), kOfxStatOK);
  return output;
}

TEST(OfxHosts, DescribesItsEffectsUnderOneGrouping) {
  const Host host(builtLibrary());
  ASSERT_EQ(host.pluginCount(), 3);
  EXPECT_EQ(host.plugin(0).pluginIdentifier, std::string("org.metamer.SpectralTransfer"));
  EXPECT_EQ(host.plugin(1).pluginIdentifier, std::string("org.metamer.LEDStage"));
  EXPECT_EQ(host.plugin(2).pluginIdentifier, std::string("org.metamer.Skin"));
  for (int i = 0; i < host.pluginCount(); ++i) {
    EXPECT_EQ(host.plugin(i).pluginApi, std::string(kOfxImageEffectPluginApi));
    const auto descriptor = host.describe(i, kOfxImageEffectContextGeneral);
    const Properties& properties = descriptor->properties;
    EXPECT_EQ(properties.text(kOfxImageEffectPluginPropGrouping), "metamer");
    EXPECT_EQ(properties.texts(kOfxImageEffectPropSupportedContexts),
              (std::vector<std::string>{kOfxImageEffectContextFilter, kOfxImageEffectContextGeneral}));
    EXPECT_EQ(properties.dimension(kOfxImageEffectPropSupportedPixelDepths), 4);
    EXPECT_EQ(properties.text(kOfxImageEffectPluginRenderThreadSafety), kOfxImageEffectRenderFullySafe);
    EXPECT_EQ(descriptor->clips.size(), 3U);
    EXPECT_EQ(descriptor->clips.at("Mask")->properties.integer(kOfxImageClipPropOptional), 1);
    for (const auto& [name, parameter] : descriptor->parameters) {
      if (parameter->type != kOfxParamTypeGroup && parameter->properties.integer(kOfxParamPropSecret) == 0) {
        EXPECT_FALSE(parameter->properties.text(kOfxParamPropHint).empty()) << name;
      }
    }
    host.act(i, kOfxActionUnload, nullptr, nullptr, nullptr);
  }
  EXPECT_EQ(host.act(0, "OfxActionOfTheFuture", nullptr, nullptr, nullptr), kOfxStatReplyDefault);
}

TEST(OfxHosts, TheResultDoesNotDependOnWhatTheHostHas) {
  const std::map<std::string, Properties::Value> settings = {{"outputIlluminant", "FL11"}, {"scene", "Data set"}};
  const Frame reference = rendered({.threads = 0}, settings);
  for (const Features& features : {Features{.threads = 1}, Features{.threads = 2}, Features{.threads = 7},
                                   Features{.threads = 3, .persistentMessages = false, .plainMessages = false}}) {
    const Frame other = rendered(features, settings);
    for (int y = 0; y < kBounds.y2; ++y) {
      for (int x = 0; x < kBounds.x2; ++x) {
        ASSERT_EQ(other.bytes(x, y), reference.bytes(x, y));
      }
    }
  }
}

TEST(OfxHosts, AHostWithoutParametersIsRefused) {
  const Host host(builtLibrary(), {.parameters = false});
  EXPECT_EQ(host.act(0, kOfxActionLoad, nullptr, nullptr, nullptr), kOfxStatErrMissingHostFeature);
  EXPECT_EQ(host.act(0, nullptr, nullptr, nullptr, nullptr), kOfxStatErrBadHandle);
}

TEST(OfxHosts, ActionsOnWhatWasNeverCreatedFail) {
  const Host host(builtLibrary());
  const auto descriptor = host.describe(0, kOfxImageEffectContextFilter);
  descriptor->properties.set(kOfxPropInstanceData, static_cast<void*>(nullptr));
  Properties in;
  EXPECT_EQ(host.act(0, kOfxImageEffectActionRender, descriptor.get(), &in, nullptr), kOfxStatErrBadHandle);
  EXPECT_EQ(host.act(0, kOfxActionDestroyInstance, descriptor.get(), nullptr, nullptr), kOfxStatOK);
  host.act(0, kOfxActionUnload, nullptr, nullptr, nullptr);
  host.act(0, kOfxActionUnload, nullptr, nullptr, nullptr);  // once too often
}

TEST(OfxHosts, LoadsAndUnloadsAgainAndAgain) {
  for (int i = 0; i < 5; ++i) {
    const Host host(builtLibrary());
    const auto first = host.create(0);
    const auto second = host.create(1);
    EXPECT_EQ(std::get<std::string>(first->get("inputIlluminantName")), "D65");
  }
}

// OFX 1.5's colour management; the names are those of its native configuration.

constexpr const char* kClipColourspace = "OfxImageClipPropColourspace";

class OfxColourManagement : public ::testing::Test {
 protected:
  Host m_host{builtLibrary(), {.colourManagement = "OfxImageEffectColourManagementFull"}};
  Frame m_source{{.bounds = kBounds}};
  Frame m_output{{.bounds = kBounds}};

  Frame::Rgba render(Instance& effect) {
    m_source.fill([](int x, int y) {
      Frame::Rgba pixel = testPixel(x, y);
      return Frame::Rgba{std::abs(pixel[0]), std::abs(pixel[1]), std::abs(pixel[2]), 1};
    });
    effect.connect("Source", m_source.image());
    effect.connect("Output", m_output.image());
    EXPECT_EQ(effect.render(kBounds), kOfxStatOK);
    return m_output.at(5, 5);
  }
};

TEST_F(OfxColourManagement, IsDeclaredToHostsThatKnowIt) {
  const auto descriptor = m_host.describe(0, kOfxImageEffectContextFilter);
  EXPECT_EQ(descriptor->properties.text("OfxImageEffectPropColourManagementStyle"),
            "OfxImageEffectColourManagementFull");
  EXPECT_EQ(descriptor->properties.text("OfxImageEffectPropColourManagementAvailableConfigs"),
            "ofx-native-v1.5_aces-v1.3_ocio-v2.3");
  m_host.act(0, kOfxActionUnload, nullptr, nullptr, nullptr);
}

TEST_F(OfxColourManagement, TheClipsSpaceStandsAboveTheMenu) {
  const auto managed = m_host.create(0, {{"outputIlluminant", "A"}, {"space", "Rec.709"}, {"scene", "Data set"}});
  const auto byMenu =
      m_host.create(0, {{"outputIlluminant", "A"}, {"space", "ARRI LogC4"}, {"scene", "Data set"}, {"hostSpace", 0}});
  const auto plain =
      m_host.create(0, {{"outputIlluminant", "A"}, {"space", "Rec.709"}, {"scene", "Data set"}, {"hostSpace", 0}});
  const auto wanted = render(*byMenu);
  const auto menu = render(*plain);
  ASSERT_NE(wanted, menu);
  managed->clip("Source").properties.set(kClipColourspace, "arri_logc4");
  EXPECT_EQ(render(*managed), wanted);
  managed->clip("Source").properties.set(kClipColourspace, "ARRI LogC4");
  EXPECT_EQ(render(*managed), wanted);
  // A generic or unknown space leaves it to the menu, and so does the switch.
  managed->clip("Source").properties.set(kClipColourspace, "ofx_scene_linear");
  EXPECT_EQ(render(*managed), menu);
  managed->clip("Source").properties.set(kClipColourspace, "arri_logc4");
  managed->set("hostSpace", 0);
  EXPECT_EQ(render(*managed), menu);
}

TEST_F(OfxColourManagement, PreferencesBeginWithTheMenuAndEndWithTheGenericSpace) {
  const auto effect = m_host.create(0, {{"space", "DaVinci Intermediate"}});
  render(*effect);
  Properties answers;
  ASSERT_EQ(effect->act(kOfxImageEffectActionGetClipPreferences, nullptr, &answers), kOfxStatOK);
  const auto spaces = answers.texts("OfxImageClipPropPreferredColourspaces_Source");
  ASSERT_FALSE(spaces.empty());
  EXPECT_EQ(spaces.front(), "davinci_intermediate_widegamut");
  EXPECT_EQ(spaces.back(), "ofx_scene_linear");
  EXPECT_EQ(answers.text("OfxImageClipPropComponents_Output"), kOfxImageComponentRGBA);
  EXPECT_EQ(answers.text("OfxImageClipPropDepth_Output"), kOfxBitDepthFloat);
  EXPECT_EQ(answers.text(kOfxImageEffectPropPreMultiplication), kOfxImageUnPreMultiplied);
  Properties in;
  Properties out;
  ASSERT_EQ(effect->act("OfxImageEffectActionGetOutputColourspace", &in, &out), kOfxStatOK);
  EXPECT_EQ(out.text(kClipColourspace), "OfxColourspace_Source");
}

TEST_F(OfxColourManagement, EveryMenuSpaceHasAName) {
  const auto effect = m_host.create(0);
  const Properties& menu = effect->effect().parameters.at("space")->properties;
  for (const std::string& space : menu.texts(kOfxParamPropChoiceOption)) {
    effect->set("space", space);
    Properties answers;
    ASSERT_EQ(effect->act(kOfxImageEffectActionGetClipPreferences, nullptr, &answers), kOfxStatOK);
    const auto spaces = answers.texts("OfxImageClipPropPreferredColourspaces_Source");
    EXPECT_TRUE(space == "ACEScg" || spaces.front() != "ACEScg") << space;
    EXPECT_EQ(spaces.size(), std::set<std::string>(spaces.begin(), spaces.end()).size());
  }
}

}  // namespace
}  // namespace bare_host
