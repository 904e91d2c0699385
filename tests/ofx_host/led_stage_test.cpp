// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "frame.h"
#include "scratch_folder.h"

namespace bare_host {
namespace {

constexpr OfxRectI kBounds = {0, 0, 30, 20};
constexpr const char* kContent = "M: content in the camera's view";
constexpr const char* kLighting = "N: content that lights the set";
constexpr const char* kPost = "Q: the camera's picture";
constexpr const char* kBlack = "Black offset";

constexpr double kM[3][3] = {{1.5, -0.25, 0.0}, {-0.125, 1.25, -0.0625}, {0.0, -0.5, 2.0}};
constexpr double kN[3][3] = {{0.5, 0.25, 0.0}, {0.0, 1.0, 0.25}, {0.125, 0.0, 0.75}};
constexpr double kQ[3][3] = {{1.0, 0.5, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.25, 1.0}};
constexpr double kOffset[3] = {-0.01, -0.02, -0.005};

std::string rows(const double (&matrix)[3][3]) {
  std::string text = "[";
  for (int i = 0; i < 3; ++i) {
    text += std::string(i == 0 ? "" : ",") + "[" + std::to_string(matrix[i][0]) + "," + std::to_string(matrix[i][1]) +
            "," + std::to_string(matrix[i][2]) + "]";
  }
  return text + "]";
}

class OfxLedStage : public ::testing::Test {
 protected:
  Host m_host{builtLibrary(), {.threads = 2}};
  ScratchFolder m_folder;
  Frame m_source{{.bounds = kBounds}};
  Frame m_output{{.bounds = kBounds}};

  std::string write(const std::string& text) {
    const auto file = m_folder.path() / "stage.json";
    std::ofstream(file) << text;
    return textOf(file);
  }
  std::string stage() {
    return write(R"({"metamer_stage": 1, "M": )" + rows(kM) + R"(, "Q": )" + rows(kQ) + R"(, "N": )" + rows(kN) +
                 R"(, "beta": 4.18, "offset": [-0.01, -0.02, -0.005], "patches": []})");
  }
  void render(Instance& effect, const char* premultiplication = kOfxImageUnPreMultiplied) {
    effect.connect("Source", m_source.image(premultiplication));
    effect.connect("Output", m_output.image(premultiplication));
    EXPECT_EQ(effect.render(kBounds), kOfxStatOK);
    EXPECT_EQ(effect.effect().imagesOut, 0);
  }
};

TEST_F(OfxLedStage, AppliesEachMatrixAndTakesItBack) {
  const auto effect = m_host.create(1, {{"stageFile", stage()}});
  const std::map<std::string, const double(*)[3]> matrices = {{kContent, kM}, {kLighting, kN}, {kPost, kQ}};
  for (const auto& [operation, matrix] : matrices) {
    effect->set("operation", operation);
    effect->set("direction", "Forward");
    m_source.fill(testPixel);
    render(*effect);
    EXPECT_EQ(effect->message(), "");
    for (int x = 0; x < kBounds.x2; ++x) {
      const auto in = m_source.at(x, 4);
      for (std::size_t i = 0; i < 3; ++i) {
        const double wanted = matrix[i][0] * in[0] + matrix[i][1] * in[1] + matrix[i][2] * in[2];
        EXPECT_NEAR(m_output.at(x, 4)[i], wanted, 1e-6 * std::max(1.0, std::abs(wanted)));
      }
      EXPECT_EQ(m_output.at(x, 4)[3], in[3]);
    }
    m_source = m_output;
    effect->set("direction", "Inverse");
    render(*effect);
    for (int x = 0; x < kBounds.x2; ++x) {
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(m_output.at(x, 4)[i], testPixel(x, 4)[i], 1e-5 * std::max(1.0F, std::abs(testPixel(x, 4)[i])));
      }
    }
  }
}

TEST_F(OfxLedStage, BlackOffsetHoldsAtZeroAndScalesWithAlpha) {
  const auto effect = m_host.create(1, {{"stageFile", stage()}, {"operation", kBlack}});
  m_source.fill([](int x, int) { return Frame::Rgba{0.005F, 0.5F, -0.3F, x < 15 ? 1.0F : 0.5F}; });
  render(*effect);
  EXPECT_EQ(m_output.at(3, 3)[0], 0.0F);
  EXPECT_NEAR(m_output.at(3, 3)[1], 0.48, 1e-6);
  EXPECT_EQ(m_output.at(3, 3)[2], 0.0F);
  effect->set("clampBlack", 0);
  render(*effect);
  EXPECT_NEAR(m_output.at(3, 3)[0], 0.005 + kOffset[0], 1e-7);
  EXPECT_NEAR(m_output.at(3, 3)[2], -0.3 + kOffset[2], 1e-7);
  render(*effect, kOfxImagePreMultiplied);
  EXPECT_NEAR(m_output.at(20, 3)[1], 0.5 + 0.5 * kOffset[1], 1e-6);
  effect->set("direction", "Inverse");
  render(*effect);
  EXPECT_NEAR(m_output.at(3, 3)[1], 0.52, 1e-6);
}

TEST_F(OfxLedStage, EncodedPixelsAreDecodedAround) {
  const auto effect = m_host.create(1, {{"stageFile", stage()}, {"operation", kPost}, {"curve", "ACEScct"}});
  // ACEScct of 0.18 on every channel; rows of Q that sum to 1.5, 1 and 1.25.
  m_source.fill([](int, int) { return Frame::Rgba{0.4135884F, 0.4135884F, 0.4135884F, 1}; });
  render(*effect);
  const auto acescct = [](double linear) { return (std::log2(linear) + 9.72) / 17.52; };
  EXPECT_NEAR(m_output.at(1, 1)[0], acescct(0.27), 1e-6);
  EXPECT_NEAR(m_output.at(1, 1)[1], acescct(0.18), 1e-6);
  EXPECT_NEAR(m_output.at(1, 1)[2], acescct(0.225), 1e-6);
}

TEST_F(OfxLedStage, WithoutAFileNothingChanges) {
  const auto effect = m_host.create(1);
  m_source.fill(testPixel);
  render(*effect);
  EXPECT_EQ(effect->identity(kBounds), "Source");
  EXPECT_EQ(m_output.bytes(3, 3), m_source.bytes(3, 3));
  EXPECT_EQ(effect->message(), "");
}

TEST_F(OfxLedStage, BadFilesPassThePictureThroughAndAreTold) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "is not JSON"},
      {"[1, 2", "is not JSON"},
      {"[]", "must be a JSON object"},
      {"{}", "M"},
      {R"({"M": [[1,0,0],[0,1,0]]})", "three rows"},
      {R"({"M": [[1,0,0],[0,1],[0,0,1]]})", "M[1]"},
      {R"({"M": [[1,0,0],[0,"x",0],[0,0,1]]})", "M[1]"},
      {R"({"M": [[1,0,0],[0,1e999,0],[0,0,1]]})", "stage.json"},
      {R"({"M": [[1,0,0],[0,1,0],[0,0,1]], "Q": 3})", "Q"},
      {std::string(100000, '['), "stage.json"},
  };
  for (const auto& [text, says] : cases) {
    const auto effect = m_host.create(1, {{"stageFile", write(text)}});
    m_source.fill(testPixel);
    render(*effect);
    EXPECT_EQ(m_output.bytes(3, 3), m_source.bytes(3, 3)) << text.substr(0, 60);
    EXPECT_NE(effect->message().find(says), std::string::npos) << effect->message();
    EXPECT_NE(effect->message().find("stage.json"), std::string::npos) << effect->message();
  }
  const auto gone = m_host.create(1, {{"stageFile", textOf(m_folder.path() / "gone.json")}});
  render(*gone);
  for (const char* says : {"gone.json", "stageFile", "no such file", "lutgen stage solve"}) {
    EXPECT_NE(gone->message().find(says), std::string::npos) << gone->message();
  }
}

TEST_F(OfxLedStage, AMatrixOfRankOneHasNoInverse) {
  const double flat[3][3] = {{1, 1, 1}, {1, 1, 1}, {1, 1, 1.0000001}};
  const std::string file =
      write(R"({"M": )" + rows(kM) + R"(, "N": )" + rows(kN) + R"(, "Q": )" + rows(flat) + R"(, "offset": [0, 0, 0]})");
  const auto effect = m_host.create(1, {{"stageFile", file}, {"operation", kPost}, {"direction", "Inverse"}});
  m_source.fill(testPixel);
  render(*effect);
  EXPECT_EQ(m_output.bytes(3, 3), m_source.bytes(3, 3));
  EXPECT_NE(effect->message().find("no inverse"), std::string::npos) << effect->message();
}

}  // namespace
}  // namespace bare_host
