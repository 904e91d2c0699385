// SPDX-License-Identifier: Apache-2.0
// Menus and their memories, files, messages, and what is built when.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>

#include "frame.h"
#include "scratch_folder.h"

namespace bare_host {
namespace {

constexpr OfxRectI kBounds = {0, 0, 20, 10};

class OfxParameters : public ::testing::Test {
 protected:
  Host m_host{builtLibrary()};
  ScratchFolder m_folder;
  Frame m_source{{.bounds = kBounds}};
  Frame m_output{{.bounds = kBounds}};

  std::string write(const std::filesystem::path& name, const std::string& text) {
    std::ofstream(m_folder.path() / name) << text;
    return textOf(m_folder.path() / name);
  }

  Frame::Rgba render(Instance& effect, double time = 0) {
    m_source.fill(testPixel);
    m_output.fill([](int, int) { return Frame::Rgba{}; });
    effect.connect("Source", m_source.image());
    effect.connect("Output", m_output.image());
    EXPECT_EQ(effect.render(kBounds, time), kOfxStatOK);
    EXPECT_EQ(effect.effect().imagesOut, 0);
    return m_output.at(3, 3);
  }

  /// The picture passes through, and the message says all of `says`.
  void expectPassesThrough(Instance& effect, const std::vector<std::string>& says) {
    const Frame::Rgba result = render(effect);
    EXPECT_EQ(result, m_source.at(3, 3));
    for (const std::string& text : says) {
      EXPECT_NE(effect.message().find(text), std::string::npos) << effect.message();
    }
    EXPECT_EQ(effect.message().find('\n'), std::string::npos);
    EXPECT_EQ(effect.identity(kBounds), "");
  }
};

TEST_F(OfxParameters, MenusAreRememberedByName) {
  const auto effect = m_host.create(0);
  EXPECT_EQ(std::get<std::string>(effect->get("outputIlluminantName")), "D65");
  effect->set("outputIlluminant", "HP1");
  EXPECT_EQ(std::get<std::string>(effect->get("outputIlluminantName")), "HP1");
  const auto descriptor = m_host.describe(0, kOfxImageEffectContextFilter);
  EXPECT_EQ(descriptor->parameters.at("outputIlluminantName")->properties.integer(kOfxParamPropSecret), 1);
  m_host.act(0, kOfxActionUnload, nullptr, nullptr, nullptr);
}

TEST_F(OfxParameters, AProjectFromAnotherReleaseKeepsItsNames) {
  // The position is another release's; the name counts.
  const auto effect =
      m_host.create(0, {{"outputIlluminant", 5}, {"outputIlluminantName", std::string("HP1")}, {"scene", "Data set"}});
  EXPECT_EQ(effect->menuOption("outputIlluminant"), "HP1");
  const auto reference = m_host.create(0, {{"outputIlluminant", "HP1"}, {"scene", "Data set"}});
  EXPECT_EQ(render(*effect), render(*reference));
  effect->set("outputIlluminantName", std::string("A"));
  EXPECT_EQ(effect->menuOption("outputIlluminant"), "A");
}

TEST_F(OfxParameters, ANameThatIsGoneIsToldWithNearOnes) {
  const auto effect = m_host.create(
      0, {{"outputIlluminant", 3}, {"outputIlluminantName", std::string("FL111")}, {"scene", "Data set"}});
  expectPassesThrough(*effect, {"output", "illuminant", "FL111", "near names", "FL11"});
  effect->set("outputIlluminant", "FL11");
  EXPECT_NE(render(*effect), m_source.at(3, 3));
  EXPECT_EQ(effect->message(), "");
}

TEST_F(OfxParameters, AMissingRecipePassesThePictureThroughUntilItIsThere) {
  const auto effect = m_host.create(0);
  const std::string file = textOf(m_folder.path() / "100 %s day.yaml");
  effect->set("recipeFile", file);
  expectPassesThrough(*effect, {file, "recipeFile", "no such file", "choose the recipe anew"});
  const int shown = effect->effect().messagesShown;
  render(*effect);
  EXPECT_EQ(effect->effect().messagesShown, shown) << "the same message is not shown anew";
  write("100 %s day.yaml",
        "metamer: 1\nscene: {kind: dataset, set: skin}\ninput: {illuminant: D65}\noutput: {illuminant: A}\n");
  const auto warm = render(*effect);
  EXPECT_NE(warm, m_source.at(3, 3));
  EXPECT_EQ(effect->message(), "");
  write("100 %s day.yaml",
        "metamer: 1\nscene: {kind: dataset, set: skin}\ninput: {illuminant: D65}\noutput: {illuminant: HP1}\n");
  EXPECT_NE(render(*effect), warm) << "an edited recipe is read anew";
  write("100 %s day.yaml", "metamer: 1\ninput: {illuminant: D65}\noutput: {illumiant: HP1}\n");
  expectPassesThrough(*effect, {":3", "illumiant"});
}

TEST_F(OfxParameters, SpectraFromFilesAreFollowed) {
  const std::string light = write("lamp", "nm,power\n380,1\n580,1\n780,3\n");
  const auto effect = m_host.create(0, {{"outputIlluminant", "From file"}, {"scene", "Data set"}});
  expectPassesThrough(*effect, {"outputIlluminantFile", "no file is chosen"});
  effect->set("outputIlluminantFile", textOf(m_folder.path() / "lamp.csv"));
  expectPassesThrough(*effect, {"lamp.csv", "outputIlluminantFile", "no such file", "choose the file anew"});
  write("lamp.csv", "nm,power\n380,1\n580,1\n780,3\n");
  const auto first = render(*effect);
  EXPECT_NE(first, m_source.at(3, 3));
  EXPECT_EQ(effect->message(), "");
  write("lamp.csv", "nm,power\n380,3\n580,1\n780,1\n# longer\n");
  EXPECT_NE(render(*effect), first);
  write("lamp.csv", "nm,power\n380,-3\n580,1\n");
  expectPassesThrough(*effect, {"lamp.csv", "-3"});
}

TEST_F(OfxParameters, FilesAreNamedInAnyScript) {
  const std::string light = "nm,power\n380,1\n580,1\n780,3\n";
  const std::string recipe =
      "metamer: 1\nscene: {kind: dataset, set: skin}\ninput: {illuminant: D65}\noutput: {illuminant: ";
  write("lamp.csv", light);
  const auto plain = m_host.create(0, {{"recipeFile", write("day.yaml", recipe + "lamp.csv}\n")}});
  const Frame::Rgba expected = render(*plain);
  EXPECT_EQ(plain->message(), "");
  EXPECT_NE(expected, m_source.at(3, 3));
  write(pathOf("лампа ☀.csv"), light);
  const auto named = m_host.create(0, {{"recipeFile", write(pathOf("夜景 é.yaml"), recipe + "лампа ☀.csv}\n")}});
  EXPECT_EQ(render(*named), expected);
  EXPECT_EQ(named->message(), "");
  named->set("recipeFile", textOf(m_folder.path() / pathOf("無い.yaml")));
  expectPassesThrough(*named, {"無い.yaml", "no such file"});
}

TEST_F(OfxParameters, OutOfRangeTemperaturesAndDarkFiltersAreTold) {
  const auto effect =
      m_host.create(0, {{"outputIlluminant", "CIE daylight"}, {"outputTemperature", 3000.0}, {"scene", "Data set"}});
  expectPassesThrough(*effect, {"3000", "4000"});
  effect->set("outputIlluminant", "Blackbody");
  EXPECT_NE(render(*effect), m_source.at(3, 3));
  const std::string black = write("black.csv", "nm,t\n400,0\n700,0\n");
  effect->set("outputFilter", "From file");
  effect->set("outputFilterFile", black);
  expectPassesThrough(*effect, {"filters stop all the light"});
}

TEST_F(OfxParameters, EveryMenuEntryOfEveryMenuWorks) {
  const auto effect = m_host.create(0, {{"quality", "Exact"}, {"outputIlluminant", "A"}});
  for (const char* menu : {"outputIlluminant", "outputFilter", "inputObserver", "sceneSet", "space", "cat"}) {
    const auto options = effect->effect().parameters.at(menu)->properties.texts(kOfxParamPropChoiceOption);
    const std::string before = effect->menuOption(menu);
    if (menu == std::string("sceneSet")) {
      effect->set("scene", "Data set");
    }
    for (const std::string& option : options) {
      if (option != "From file" && option != "CIE daylight") {
        effect->set(menu, option);
        render(*effect);
        EXPECT_EQ(effect->message(), "") << menu << " " << option;
      }
    }
    effect->set(menu, before);
  }
}

TEST_F(OfxParameters, PairsComeFromTheirFile) {
  const auto effect = m_host.create(0, {{"quality", "Exact"}, {"outputIlluminant", "A"}});
  const auto natural = render(*effect);
  effect->set("scene", "Pairs");
  expectPassesThrough(*effect, {"pairsFile", "no file is chosen"});
  // Two colours of every brightness that reflect in two stretches of wavelengths alone: no surface does.
  effect->set("pairsFile", write("pairs.csv",
                                 "nm,one,two\n380,0,0.9\n440,0,0.9\n441,0.9,0\n580,0.9,0\n581,0,0.9\n"
                                 "780,0,0.9\n"));
  effect->set("pairsRadius", 4.0);
  const auto paired = render(*effect);
  EXPECT_EQ(effect->message(), "");
  EXPECT_NE(paired, natural);
  effect->set("pairsFile", write("bad.csv", "pair,light,X,Y,Z\ncoat,D65,9,9,9\n"));
  expectPassesThrough(*effect, {"bad.csv", "coat under D65"});
}

TEST_F(OfxParameters, WhatHasNoSayIsGreyedOut) {
  const auto effect = m_host.create(0);
  const auto isEnabled = [&](const char* name) {
    return effect->effect().parameters.at(name)->properties.integer(kOfxParamPropEnabled) != 0;
  };
  EXPECT_FALSE(isEnabled("outputTemperature"));
  EXPECT_FALSE(isEnabled("outputIlluminantFile"));
  EXPECT_FALSE(isEnabled("priorStrength"));
  effect->set("outputIlluminant", "Blackbody");
  EXPECT_TRUE(isEnabled("outputTemperature"));
  effect->set("scene", "Skin");
  EXPECT_TRUE(isEnabled("priorStrength"));
  EXPECT_FALSE(isEnabled("sceneSet"));
  effect->set("scene", "Data set");
  EXPECT_FALSE(isEnabled("priorStrength"));
  EXPECT_TRUE(isEnabled("sceneSet"));
  EXPECT_FALSE(isEnabled("pairsFile"));
  effect->set("scene", "Pairs");
  EXPECT_TRUE(isEnabled("pairsFile"));
  EXPECT_TRUE(isEnabled("pairsRadius"));
  effect->set("recipeFile", std::string("day.yaml"));
  EXPECT_FALSE(isEnabled("outputTemperature"));
  EXPECT_FALSE(isEnabled("space"));
  EXPECT_TRUE(isEnabled("mix"));
  EXPECT_TRUE(isEnabled("quality"));
}

// A file that changes behind its size and date shows whether it was read again.
TEST_F(OfxParameters, NothingIsBuiltTwice) {
  const std::string file = write("lamp.csv", "nm,power\n380,1\n580,1\n780,3\n");
  const auto date = std::filesystem::last_write_time(pathOf(file));
  const auto lit = [&](double mix) {
    return m_host.create(
        0, {{"outputIlluminant", "From file"}, {"outputIlluminantFile", file}, {"scene", "Data set"}, {"mix", mix}});
  };
  const auto effect = lit(1.0);
  const Frame::Rgba first = render(*effect);

  write("lamp.csv", "nm,power\n380,3\n580,1\n780,1\n");
  std::filesystem::last_write_time(pathOf(file), date);
  EXPECT_EQ(render(*effect), first);
  // Mix has no part in the engine; neither has another instance, nor the light that is set and taken back.
  effect->set("mix", 0.5);
  const Frame::Rgba half = render(*effect);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(half[k], 0.5 * (first[k] + m_source.at(3, 3)[k]), 1e-5);
  }
  effect->set("mix", 1.0);
  effect->set("outputIlluminant", "D65");
  EXPECT_NE(render(*effect), first);
  effect->set("outputIlluminant", "From file");
  EXPECT_EQ(render(*effect), first);
  EXPECT_EQ(render(*lit(1.0)), first);

  // It would have been another picture.
  std::filesystem::last_write_time(pathOf(file), date + std::chrono::seconds(2));
  EXPECT_NE(render(*effect), first);
}

}  // namespace
}  // namespace bare_host
