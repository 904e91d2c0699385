// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/feasible_cone.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "metamer/sip/smoothest_spectrum.h"
#include "sip/sip_fixture.h"

namespace metamer::sip {
namespace {

struct NamedCone {
  std::string name;
  FeasibleCone cone;
};

/// Three-dimensional cones of lamps, a flat one and a half-line.
const std::vector<NamedCone>& cones() {
  static const std::vector<NamedCone> all = [] {
    std::vector<NamedCone> made;
    for (const char* const light : {"D65", "HP1", "FL11", "LED-RGB1"}) {
      made.push_back({light, FeasibleCone(normalisedWeights(light, 81), Eigen::Matrix3d::Identity())});
    }
    Eigen::Matrix<double, 3, 2> plane;
    plane.col(0) = Eigen::Vector3d(1, 1, 1).normalized();
    plane.col(1) = Eigen::Vector3d(1, -1, 0).normalized();
    made.push_back({"flat", FeasibleCone(normalisedWeights("HP1", 81), plane)});
    made.push_back({"half-line", FeasibleCone(normalisedWeights("HP1", 81), plane.leftCols(1))});
    return made;
  }();
  return all;
}

std::vector<Eigen::Vector3d> randomColours(int count) {
  std::mt19937 random(7);
  const auto uniform = [&random] { return 2.0 * unitRandom(random) - 1.0; };
  std::vector<Eigen::Vector3d> colours;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d colour{uniform(), uniform(), uniform()};  // in braces: one after another
    // Half of them around white, where most pieces meet.
    colours.push_back(i % 2 == 0 ? colour : Eigen::Vector3d(Eigen::Vector3d::Ones() + colour));
  }
  return colours;
}

TEST(FeasibleConeTest, ProjectionStaysAndIsIdempotent) {
  for (const auto& [name, cone] : cones()) {
    spectral::MaxDifference again(name + ": projected twice", 1e-12);
    spectral::MaxDifference matrix(name + ": matrix * colour", 1e-12);
    for (const Eigen::Vector3d& colour : randomColours(20'000)) {
      const auto once = cone.project(colour);
      again.add(cone.project(once.point).point, once.point);
      matrix.add(once.matrix * colour, once.point);
      ASSERT_LE(once.point.norm(), colour.norm() * (1 + 1e-12)) << name;
    }
  }
}

TEST(FeasibleConeTest, ProjectionIsTheNearestPoint) {
  for (const auto& [name, cone] : cones()) {
    spectral::MaxDifference normal(name + ": what is left meets no corner", 1e-12);
    for (const Eigen::Vector3d& colour : randomColours(5'000)) {
      const Eigen::Vector3d point = cone.project(colour).point;
      // Moreau: the rest is perpendicular to the point and makes no acute angle with any generator.
      const Eigen::Vector3d rest = colour - point;
      normal.add(rest.dot(point), 0.0);
      for (const Eigen::Vector3d& corner : cone.corners()) {
        normal.add(std::max(0.0, rest.dot(corner)), 0.0);
      }
    }
  }
}

TEST(FeasibleConeTest, ProjectionIsNonExpansiveAndContinuous) {
  for (const auto& [name, cone] : cones()) {
    const std::vector<Eigen::Vector3d> colours = randomColours(20'000);
    for (std::size_t i = 0; i + 1 < colours.size(); ++i) {
      const double apart = (cone.project(colours[i]).point - cone.project(colours[i + 1]).point).norm();
      ASSERT_LE(apart, (colours[i] - colours[i + 1]).norm() + 1e-12) << name;
      const Eigen::Vector3d near = colours[i] + 1e-7 * colours[i + 1];
      ASSERT_LE((cone.project(colours[i]).point - cone.project(near).point).norm(), (colours[i] - near).norm() + 1e-12)
          << name << ": " << colours[i].transpose();
    }
  }
}

TEST(FeasibleConeTest, ProjectionIsHomogeneous) {
  for (const auto& [name, cone] : cones()) {
    for (const Eigen::Vector3d& colour : randomColours(2'000)) {
      const auto one = cone.project(colour);
      const auto many = cone.project(1024.0 * colour);
      ASSERT_EQ(Eigen::Vector3d(1024.0 * one.point), many.point) << name;
      ASSERT_EQ(one.piece, many.piece) << name;
    }
  }
}

TEST(FeasibleConeTest, Apex) {
  for (const auto& [name, cone] : cones()) {
    EXPECT_TRUE(cone.project(Eigen::Vector3d::Zero()).point.isZero(0.0)) << name;
    // Behind all corners there is nothing nearer than black.
    EXPECT_TRUE(cone.project(Eigen::Vector3d(-1, -1, -1)).point.isZero(0.0)) << name;
  }
}

TEST(FeasibleConeTest, WhiteIsInsideAndTheLocusOutside) {
  for (const char* const light : {"D65", "HP1", "FL11", "LED-RGB1"}) {
    const Eigen::Matrix3Xd weights = normalisedWeights(light, 81);
    const FeasibleCone cone(weights, Eigen::Matrix3d::Identity());
    EXPECT_EQ(cone.rank(), 3);
    EXPECT_GE(cone.corners().size(), 3U);
    EXPECT_TRUE(cone.contains(Eigen::Vector3d::Ones()));
    EXPECT_EQ(cone.project(Eigen::Vector3d::Ones()).piece, 0);
    EXPECT_FALSE(cone.contains(Eigen::Vector3d(-1, 1, 1)));
    for (const Eigen::Vector3d& corner : cone.corners()) {
      EXPECT_NEAR(corner.norm(), 1.0, 1e-12);
      // Drawn in to white by the margin: a little further out is outside.
      const Eigen::Vector3d out = corner / corner.sum() - 1e-5 * Eigen::Vector3d::Constant(1.0 / 3.0);
      EXPECT_FALSE(cone.contains(out)) << light;
    }
  }
}

TEST(FeasibleConeTest, WithinIsWhatBothHold) {
  for (const auto& [nameA, a] : cones()) {
    for (const auto& [nameB, b] : cones()) {
      if (a.rank() != b.rank()) {
        continue;
      }
      const FeasibleCone both = a.within(b);
      int inside = 0;
      for (const Eigen::Vector3d& colour : randomColours(5'000)) {
        EXPECT_EQ(both.contains(colour), a.contains(colour) && b.contains(colour)) << nameA << " within " << nameB;
        inside += both.contains(colour) ? 1 : 0;
        // A flat cone contains by its projection.
        if (a.rank() == 2) {
          const Eigen::Vector3d point = both.project(colour).point;
          EXPECT_LE((a.project(point).point - point).norm(), 1e-12 * colour.norm());
        }
      }
      EXPECT_EQ(inside > 0, a.rank() == 3) << nameA << " within " << nameB;
    }
  }
}

TEST(FeasibleConeTest, FlatConesShareTheNarrowerSide) {
  Eigen::Matrix<double, 3, 2> plane;
  plane.col(0) = Eigen::Vector3d(1, 1, 1).normalized();
  plane.col(1) = Eigen::Vector3d(1, -1, 0).normalized();
  const auto wedge = [&](double low, double high) {
    Eigen::Matrix<double, 3, 2> rays;
    rays.col(0) = plane * Eigen::Vector2d(1, low);
    rays.col(1) = plane * Eigen::Vector2d(1, high);
    return FeasibleCone(rays, plane);
  };
  const FeasibleCone both = wedge(-0.5, 0.2).within(wedge(-0.1, 0.4));
  const FeasibleCone expected = wedge(-0.1, 0.2);
  for (std::size_t side = 0; side < 2; ++side) {
    EXPECT_LE((both.corners()[side] - expected.corners()[side]).norm(), 1e-12) << side;
  }
}

TEST(FeasibleConeTest, FaintGeneratorsDoNotReachFar) {
  // Ninety-eight of white and one red, ever fainter against the average: all the way out, half, not at all.
  const auto reach = [](double heaviness) {
    Eigen::Matrix3Xd rays = Eigen::Matrix3Xd::Ones(3, 99);
    rays.col(98) =
        Eigen::Vector3d(1, 0, 0) * (heaviness * kFaintGenerator * 98 * 3 / (99 - heaviness * kFaintGenerator));
    const Eigen::Matrix3Xd lit = litGenerators(rays);
    EXPECT_EQ(lit.cols(), 99);
    return 1.0 - 3.0 * lit.col(98)[1];
  };
  EXPECT_NEAR(reach(100.0), 1.0, 1e-7);
  EXPECT_NEAR(reach(2.0), 16.0 / 17.0, 1e-12);
  EXPECT_NEAR(reach(1.0), 0.5, 1e-12);
  EXPECT_NEAR(reach(0.01), 0.0, 1e-7);
  EXPECT_EQ(litGenerators(Eigen::Matrix3d(Eigen::Vector3d(1, 1, 0).asDiagonal())).cols(), 2);
}

TEST(FeasibleConeTest, EveryCornerHasASpectrum) {
  for (const char* const light : {"D65", "HP1", "FL11", "LED-RGB1"}) {
    for (const int bands : {41, 81, kConvergedBandCount}) {
      const Eigen::Matrix3Xd weights = normalisedWeights(light, bands);
      const SmoothestSpectrumSolver solver(weights);
      const FeasibleCone cone(weights, Eigen::Matrix3d::Identity());
      for (std::size_t i = 0; i < cone.corners().size(); ++i) {
        const Eigen::Vector3d& corner = cone.corners()[i];
        const Eigen::Vector3d& next = cone.corners()[(i + 1) % cone.corners().size()];
        for (const double share : {0.0, 0.1, 0.5, 0.9}) {
          EXPECT_TRUE(solver.solve((1 - share) * corner + share * next)) << light << " " << bands << " corner " << i;
        }
      }
    }
  }
}

}  // namespace
}  // namespace metamer::sip
