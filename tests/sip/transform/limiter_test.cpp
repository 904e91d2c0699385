// SPDX-License-Identifier: Apache-2.0
#include "transform/limiter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sip/sip_fixture.h"

namespace metamer::sip {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct Case {
  Vector3d colour;
  Vector3d difference;
};

/// Colours in front of and behind v_Y = 0, differences from next to nothing to far beyond all reaches.
std::vector<Case> cases(int count) {
  std::mt19937 random(2);
  const auto any = [&random]() -> Vector3d {
    Vector3d point{unitRandom(random), unitRandom(random), unitRandom(random)};
    return 2.0 * point - Vector3d::Ones();
  };
  std::vector<Case> made;
  for (int i = 0; i < count; ++i) {
    const double size = std::pow(10.0, 4.0 * unitRandom(random) - 2.0);
    Vector3d colour = any();
    if (i % 3 != 0) {
      colour.y() = std::abs(colour.y());
    }
    const Vector3d difference = size * any();
    made.push_back({colour, difference});
  }
  return made;
}

const Limiter::Reach kRaised = {3.5, 0.95, 9.0};

/// The part of all that may be taken that a difference takes, by the limit that it comes nearest to; infinite where
/// nothing may be.
double partTaken(const Limiter::Reach& reach, const Vector3d& colour, const Vector3d& difference) {
  const auto over = [](double taken, double size) { return taken <= 0.0 ? 0.0 : taken / std::max(size, 0.0); };
  return std::max({over(difference.y(), reach.up * colour.y()), over(-difference.y(), reach.down * colour.y()),
                   over(std::abs(difference.x()), reach.aside * colour.y()),
                   over(std::abs(difference.z()), reach.aside * colour.y()), over(-difference.x(), 0.9 * colour.x()),
                   over(-difference.z(), 0.9 * colour.z())});
}

TEST(LimiterTest, LeavesAloneWhatTakesHalfItsReach) {
  for (const Limiter::Reach& reach : {Limiter::Reach{}, kRaised}) {
    const Limiter limiter(reach);
    int kept = 0;
    for (const auto& [colour, difference] : cases(2000)) {
      const bool isSmall = partTaken(reach, colour, difference) <= 0.5;
      EXPECT_EQ(limiter.keeps(colour, difference), isSmall);
      if (isSmall) {
        ++kept;
        EXPECT_EQ(limiter.apply(colour, difference), Vector3d(colour + difference));
      }
    }
    EXPECT_GT(kept, 100);
  }
}

TEST(LimiterTest, StaysWithinItsReach) {
  for (const Limiter::Reach& reach : {Limiter::Reach{}, kRaised}) {
    const Limiter limiter(reach);
    for (const auto& [colour, difference] : cases(5000)) {
      const Vector3d result = limiter.apply(colour, difference);
      const double luminance = std::max(colour.y(), 0.0);
      if (luminance == 0.0) {
        EXPECT_EQ(result.y(), colour.y());
      } else {
        EXPECT_LE(result.y(), (1.0 + reach.up) * luminance * (1.0 + 1e-14));
        EXPECT_GE(result.y(), (1.0 - reach.down) * luminance * (1.0 - 1e-14));
      }
      const double size = std::max({luminance, std::abs(colour.x()) / 8.0, std::abs(colour.z()) / 8.0});
      for (const Eigen::Index k : {0, 2}) {
        EXPECT_LE(std::abs(result[k] - colour[k]), reach.aside * size * (1.0 + 1e-14));
        // At most nine tenths are lost, and of nothing nothing.
        EXPECT_GE(result[k], std::min(colour[k], 0.1 * colour[k]) - 1e-14);
      }
    }
    // The reach itself is what an endless difference comes to.
    const Vector3d white = Vector3d::Ones();
    EXPECT_NEAR(limiter.apply(white, Vector3d(0.0, 1e9, 0.0)).y(), 1.0 + reach.up, 1e-6);
    EXPECT_NEAR(limiter.apply(white, Vector3d(0.0, -1e9, 0.0)).y(), 1.0 - reach.down, 1e-6);
    EXPECT_NEAR(limiter.apply(white, Vector3d(1e9, 0.0, 0.0)).x(), 1.0 + reach.aside, 1e-6);
    EXPECT_NEAR(limiter.apply(white, Vector3d(-1e9, 0.0, 0.0)).x(), 0.1, 1e-6);
  }
}

TEST(LimiterTest, ContinuousWhereLuminanceVanishes) {
  const Limiter limiter{Limiter::Reach{}};
  for (auto [colour, difference] : cases(2000)) {
    colour.y() = 0.0;
    const Vector3d at = limiter.apply(colour, difference);
    for (const double side : {-1e-9, 1e-9}) {
      const Vector3d beside = limiter.apply(colour + side * Vector3d::UnitY(), difference);
      // No derivative is larger than the largest reach, twice for the change of the share.
      EXPECT_LE((beside - at).norm(), 1e-9 * 16.0) << colour.transpose() << ", " << difference.transpose();
    }
  }
}

TEST(LimiterTest, SmoothWhereTheLimitSetsIn) {
  const Limiter limiter{kRaised};
  int seen = 0;
  for (const auto& [colour, difference] : cases(2000)) {
    if (colour.y() < 0.01) {
      continue;
    }
    const double part = partTaken(kRaised, colour, difference);
    if (!std::isfinite(part)) {
      continue;
    }
    const Vector3d edge = difference * (0.5 / part);
    const Limiter::Limited inside = limiter.limited(colour, (1.0 - 1e-8) * edge);
    const Limiter::Limited outside = limiter.limited(colour, (1.0 + 1e-8) * edge);
    EXPECT_LE((outside.value - inside.value).norm(), 1e-7 * edge.norm());
    EXPECT_LE((outside.byColour - inside.byColour).norm(), 1e-5);
    EXPECT_LE((outside.byDifference - inside.byDifference).norm(), 1e-5);
    EXPECT_TRUE(limiter.keeps(colour, (1.0 - 1e-8) * edge));
    EXPECT_FALSE(limiter.keeps(colour, (1.0 + 1e-8) * edge));
    ++seen;
  }
  EXPECT_GT(seen, 500);
}

TEST(LimiterTest, DerivativesAgainstDifferences) {
  for (const Limiter::Reach& reach : {Limiter::Reach{}, kRaised}) {
    const Limiter limiter(reach);
    int unlike = 0;
    const std::vector<Case> all = cases(2000);
    for (const auto& [colour, difference] : all) {
      const Limiter::Limited local = limiter.limited(colour, difference);
      EXPECT_EQ(local.value, limiter.apply(colour, difference));
      Matrix3d byColour;
      Matrix3d byDifference;
      for (Eigen::Index k = 0; k < 3; ++k) {
        constexpr double kStep = 1e-6;
        const Vector3d step = kStep * Vector3d::Unit(k);
        byColour.col(k) =
            (limiter.apply(colour + step, difference) - limiter.apply(colour - step, difference)) / (2.0 * kStep);
        const double relative = kStep * difference.norm();
        const Vector3d own = relative * Vector3d::Unit(k);
        byDifference.col(k) =
            (limiter.apply(colour, difference + own) - limiter.apply(colour, difference - own)) / (2.0 * relative);
      }
      const bool isLike = (byColour - local.byColour).norm() <= 1e-4 * (1.0 + local.byColour.norm()) &&
                          (byDifference - local.byDifference).norm() <= 1e-4 * (1.0 + local.byDifference.norm());
      unlike += isLike ? 0 : 1;
    }
    // Where the largest of two changes places there is a kink; few cases are that close to one.
    EXPECT_LE(unlike, static_cast<int>(all.size()) / 200);
  }
}

TEST(LimiterTest, Homogeneous) {
  const Limiter limiter{kRaised};
  for (const auto& [colour, difference] : cases(500)) {
    const Vector3d expected = limiter.apply(colour, difference);
    EXPECT_EQ(limiter.apply(1024.0 * colour, 1024.0 * difference), Vector3d(1024.0 * expected));
    EXPECT_LE((limiter.apply(1e30 * colour, 1e30 * difference) / 1e30 - expected).norm(), 1e-14 * expected.norm());
  }
  EXPECT_TRUE(limiter.apply(Vector3d::Zero(), Vector3d::Zero()).isZero(0.0));
  EXPECT_TRUE(limiter.limited(Vector3d::Zero(), Vector3d::Zero()).byColour.allFinite());
}

TEST(LimiterTest, ReachesAreRaisedForSurfaces) {
  const auto reachFor = [](const Vector3d& each) {
    return Limiter::reachFor(std::vector<Vector3d>(100, Vector3d(0.5, 0.5, 0.5)), std::vector<Vector3d>(100, each));
  };
  const Limiter::Reach least = reachFor(Vector3d(0.1, 0.1, 0.1));
  EXPECT_EQ(least.up, 3.0);
  EXPECT_EQ(least.down, 0.8);
  EXPECT_EQ(least.aside, 4.0);
  // Twice what the surfaces take, over their luminance.
  EXPECT_NEAR(reachFor(Vector3d(0.0, 0.8, 0.0)).up, 3.2, 1e-12);
  EXPECT_NEAR(reachFor(Vector3d(0.0, -0.22, 0.0)).down, 0.88, 1e-12);
  EXPECT_NEAR(reachFor(Vector3d(0.0, 0.0, -1.5)).aside, 6.0, 1e-12);
  const Limiter::Reach most = reachFor(Vector3d(9.0, 9.0, 9.0));
  EXPECT_EQ(most.up, 3.5);
  EXPECT_EQ(most.aside, 12.0);
  EXPECT_EQ(reachFor(Vector3d(0.0, -9.0, 0.0)).down, 0.95);
  // Less than two in a hundred may take more; what is darker than nothing does not count.
  std::vector<Vector3d> colours(201, Vector3d::Ones());
  std::vector<Vector3d> differences(201, Vector3d::Zero());
  differences[0].y() = 100.0;
  differences[1].y() = 100.0;
  colours[2].y() = -1.0;
  differences[2].y() = 100.0;
  EXPECT_EQ(Limiter::reachFor(colours, differences).up, 3.0);
  EXPECT_EQ(Limiter::reachFor({}, {}).up, 3.0);
}

}  // namespace
}  // namespace metamer::sip
