// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral_ref/checkpoint.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "spectral/temporary_folder.h"
#include "spectral_ref/scene_fixture.h"

namespace metamer::spectral_ref {
namespace {

using spectral::errorOf;

class CheckpointTest : public testing::Test {
 protected:
  std::filesystem::path file(const std::string& name) const { return scratchFile(name); }
};

/// A state in pieces of odd sizes.
std::function<void(const ByteSink&)> handing(const std::vector<unsigned char>& state) {
  return [&state](const ByteSink& sink) {
    for (std::size_t i = 0; i < state.size(); i += 333333) {
      sink(state.data() + i, std::min(state.size() - i, std::size_t{333333}));
    }
  };
}

/// A file's state, taken in pieces of other sizes.
std::vector<unsigned char> stateIn(const std::filesystem::path& file) {
  std::vector<unsigned char> state;
  readCheckpoint(file, [&](const ByteSource& source) {
    state.resize(source.size);
    for (std::size_t i = 0; i < state.size(); i += 77777) {
      source.take(state.data() + i, std::min(state.size() - i, std::size_t{77777}));
    }
  });
  return state;
}

std::string errorOfRestoring(const Scene& scene, const RenderOptions& options, std::uint64_t first,
                             const std::vector<unsigned char>& state) {
  return errorOf([&] {
    Renderer renderer(scene, options, first);
    restoreFrom(renderer, state);
  });
}

TEST_F(CheckpointTest, ALargeOneComesBackAsItWas) {
  std::vector<unsigned char> state(5'000'003);
  for (std::size_t i = 0; i < state.size(); ++i) {
    state[i] = static_cast<unsigned char>(i * i / 7);
  }
  writeCheckpoint(handing(state), file("large"));
  EXPECT_EQ(stateIn(file("large")), state);
}

TEST_F(CheckpointTest, ComesBackAsItWas) {
  const std::vector<unsigned char> state = {1, 2, 3, 0, 255, 7, 8, 9, 10, 11};
  writeCheckpoint(handing(state), file("whole"));
  EXPECT_EQ(stateIn(file("whole")), state);
}

TEST_F(CheckpointTest, DamageIsNoticed) {
  std::vector<unsigned char> state(1000, 5);
  writeCheckpoint(handing(state), file("damaged"));
  std::string bytes(1008, '\0');
  std::ifstream(file("damaged"), std::ios::binary).read(bytes.data(), 1008);
  for (const std::size_t place : {std::size_t{0}, std::size_t{500}, std::size_t{1007}}) {
    std::string changed = bytes;
    changed[place] = static_cast<char>(changed[place] ^ 1);
    std::ofstream(file("damaged"), std::ios::binary) << changed;
    EXPECT_NE(errorOf([&] { stateIn(file("damaged")); }).find("is damaged"), std::string::npos) << place;
  }
  std::ofstream(file("damaged"), std::ios::binary) << bytes.substr(0, 999);
  EXPECT_NE(errorOf([&] { stateIn(file("damaged")); }).find("is damaged"), std::string::npos);
  EXPECT_NE(errorOf([&] { stateIn(file("none")); }).find("cannot be read"), std::string::npos);
}

TEST_F(CheckpointTest, NothingIsTakenFromADamagedOne) {
  writeCheckpoint(handing(std::vector<unsigned char>(3'000'000, 5)), file("untouched"));
  std::fstream(file("untouched"), std::ios::binary | std::ios::in | std::ios::out).seekp(2'999'999).put(4);
  bool isTaken = false;
  EXPECT_NE(errorOf([&] {
              readCheckpoint(file("untouched"), [&](const ByteSource&) { isTaken = true; });
            }).find("is damaged"),
            std::string::npos);
  EXPECT_FALSE(isTaken);
}

TEST_F(CheckpointTest, OfAnotherRenderIsRefused) {
  const Scene scene = sceneOf(chartScene(4, "A", 12, 8));
  Renderer renderer(scene, {});
  renderer.render(2, 1e9);
  const auto state = stateOf(renderer);
  const Scene other = sceneOf(chartScene(4, "D65", 12, 8));
  EXPECT_NE(errorOfRestoring(other, {}, 0, state).find("scene"), std::string::npos);
  RenderOptions seed;
  seed.seed = 3;
  EXPECT_NE(errorOfRestoring(scene, seed, 0, state).find("seed"), std::string::npos);
  EXPECT_NE(errorOfRestoring(scene, {}, 5, state).find("first sample"), std::string::npos);
  for (const std::size_t size : {std::size_t{0}, std::size_t{9}, state.size() - 1}) {
    const std::vector<unsigned char> cut(state.begin(), state.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_NE(errorOfRestoring(scene, {}, 0, cut).find("is damaged"), std::string::npos) << size;
  }
}

}  // namespace
}  // namespace metamer::spectral_ref
