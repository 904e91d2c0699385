// SPDX-License-Identifier: Apache-2.0
#include "effects/shared_cache.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <thread>
#include <vector>

namespace metamer::ofx {
namespace {

using Cache = SharedCache<int>;

Cache::Built built(int value) {
  return {std::make_shared<const int>(value), {}};
}

TEST(SharedCache, BuildsOnceHoweverManyAsk) {
  Cache cache(4);
  std::atomic<int> builds = 0;
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 16; ++i) {
      threads.emplace_back([&] {
        const auto value = cache.get("a", [&] {
          ++builds;
          std::this_thread::sleep_for(std::chrono::milliseconds(20));
          return built(7);
        });
        EXPECT_EQ(*value, 7);
      });
    }
  }
  EXPECT_EQ(builds, 1);
}

TEST(SharedCache, TheLatestAreKeptAndHeldOnesLive) {
  Cache cache(2);
  int builds = 0;
  const auto ask = [&](const std::string& key, int value) {
    return cache.get(key, [&] {
      ++builds;
      return built(value);
    });
  };
  const auto held = ask("a", 1);
  ask("b", 2);
  ask("a", 1);
  ask("c", 3);  // b goes
  EXPECT_EQ(builds, 3);
  ask("a", 1);
  EXPECT_EQ(builds, 3);
  ask("b", 4);  // c goes
  ask("c", 5);  // a goes
  EXPECT_EQ(builds, 5);
  EXPECT_EQ(*held, 1);
}

TEST(SharedCache, AFailedBuildIsToldToAllWhoWaitAndTriedAgain) {
  Cache cache(2);
  std::atomic<int> failures = 0;
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 8; ++i) {
      threads.emplace_back([&] {
        try {
          cache.get("a", []() -> Cache::Built {
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
            throw std::runtime_error("no");
          });
        } catch (const std::runtime_error&) {
          ++failures;
        }
      });
    }
  }
  EXPECT_EQ(failures, 8);
  EXPECT_EQ(*cache.get("a", [] { return built(3); }), 3);
}

TEST(SharedCache, AChangedFileBuildsAnew) {
  const auto file = std::filesystem::temp_directory_path() / ("metamer_cache_" + std::to_string(::getpid()));
  Cache cache(2);
  int builds = 0;
  const auto ask = [&] {
    return *cache.get("a", [&] {
      Cache::Built result = built(++builds);
      result.files.add(file);
      return result;
    });
  };
  EXPECT_EQ(ask(), 1);
  EXPECT_EQ(ask(), 1);
  std::ofstream(file) << "there";
  EXPECT_EQ(ask(), 2);
  std::ofstream(file) << "longer";
  EXPECT_EQ(ask(), 3);
  EXPECT_EQ(ask(), 3);
  std::filesystem::remove(file);
  EXPECT_EQ(ask(), 4);
}

}  // namespace
}  // namespace metamer::ofx
