// SPDX-License-Identifier: Apache-2.0
// The order of lights in the tree: by place, those at one place by number, whatever order they come in.
#include "lights/light_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <random>
#include <string>
#include <vector>

namespace metamer::spectral_ref {
namespace {

std::vector<LightBounds> inARow(const std::vector<float>& places) {
  std::vector<LightBounds> lights(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    lights[i].least = lights[i].most = Vec3(0, places[i], 0);
    lights[i].intensity = 1;
  }
  return lights;
}

void expectInOrder(const std::vector<float>& places, const std::string& what) {
  std::vector<std::uint32_t> expected(places.size());
  std::iota(expected.begin(), expected.end(), 0U);
  std::stable_sort(expected.begin(), expected.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return places[a] < places[b]; });
  const LightTree tree(inARow(places));
  ASSERT_EQ(tree.lightCount(), places.size());
  for (std::uint32_t i = 0; i < expected.size(); ++i) {
    ASSERT_EQ(tree.lightAt(i), expected[i]) << what << ", position " << i;
    ASSERT_EQ(tree.positionOf(expected[i]), i) << what;
  }
}

TEST(LightTreeTest, LightsInARowAreInOrder) {
  constexpr std::size_t kCount = 5000;
  std::mt19937 random(7);
  std::vector<float> places(kCount);
  std::uniform_real_distribution<float> anywhere(-1e3F, 1e3F);
  std::generate(places.begin(), places.end(), [&] { return anywhere(random); });
  expectInOrder(places, "by chance");
  std::sort(places.begin(), places.end());
  expectInOrder(places, "in order");
  std::reverse(places.begin(), places.end());
  expectInOrder(places, "backwards");
  // Few places for many, both zeros among them, which are one.
  const std::vector<float> few = {-2.0F, -0.0F, 0.0F, 1e-30F, 3.0F};
  std::generate(places.begin(), places.end(), [&] { return few[random() % few.size()]; });
  expectInOrder(places, "few places");
  std::fill(places.begin(), places.end(), 1.0F);
  expectInOrder(places, "one place");
  // Up and down: pivots from even steps are not in the middle.
  for (std::size_t i = 0; i < kCount; ++i) {
    places[i] = static_cast<float>(i % 2 == 0 ? i : 2 * kCount - i);
  }
  expectInOrder(places, "two rows");
}

}  // namespace
}  // namespace metamer::spectral_ref
