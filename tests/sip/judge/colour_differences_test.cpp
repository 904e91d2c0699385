// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/colour_differences.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "metamer/spectral/colorimetry.h"
#include "metamer/spectral/input_error.h"
#include "vector/instruction_sets.h"

namespace metamer::sip {
namespace {

using Colours = std::vector<Eigen::Vector3d>;

const Eigen::Vector3d kWhite(0.95, 1.0, 1.09);

/// Sets instruction sets back, so that no other test runs on less than there is.
class ColourDifferencesTest : public testing::Test {
 protected:
  ~ColourDifferencesTest() override { allowInstructionSets(0); }
};

std::vector<double> measured(const Colours& lab, const Colours& xyz) {
  std::vector<double> result(lab.size());
  ColourDifferences(Eigen::Matrix3d::Identity(), kWhite).measure(lab, xyz, result);
  return result;
}

/// Wanted colours as XYZ and given ones: far apart and next to each other, dark, brighter than white, beyond real
/// colours, neutral, equal, and of opposite hues.
struct Pairs {
  Colours wanted, given;

  Pairs() {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const auto colour = [&] { return Eigen::Vector3d(unit(random), unit(random), unit(random)); };
    for (int i = 0; i < 4001; ++i) {
      const double size = std::pow(10.0, 6.0 * unit(random) - 4.0);
      const Eigen::Vector3d one = size * (i % 7 == 0 ? kWhite : Eigen::Vector3d(colour() - 0.1 * colour()));
      const double apart = std::pow(10.0, -6.0 * unit(random));
      wanted.push_back(one);
      given.push_back(i % 11 == 0   ? one
                      : i % 13 == 0 ? Eigen::Vector3d(size * kWhite)
                                    : Eigen::Vector3d(one + apart * size * (colour() - colour())));
    }
  }
  Colours wantedLab() const {
    Colours lab;
    for (const Eigen::Vector3d& xyz : wanted) {
      lab.push_back(spectral::lab(xyz, kWhite));
    }
    return lab;
  }
};

TEST_F(ColourDifferencesTest, AreDeltaE2000) {
  const Pairs pairs;
  const Colours lab = pairs.wantedLab();
  const std::vector<double> found = measured(lab, pairs.given);
  int greys = 0;
  for (std::size_t i = 0; i < lab.size(); ++i) {
    const Eigen::Vector3d other = spectral::lab(pairs.given[i], kWhite);
    // A grey's hue, and with it the mean hue, is what rounding makes of it.
    const auto isGrey = [](const Eigen::Vector3d& one) { return one.tail<2>().norm() < 1e-9 * std::abs(one[0]); };
    if (isGrey(lab[i]) != isGrey(other)) {
      EXPECT_NEAR(found[i], spectral::deltaE2000(lab[i], other), 0.2 * found[i]);
      ++greys;
      continue;
    }
    // What rounding of CIELAB itself makes of colours that are equal but for it.
    const double allowed = 1e-11 + 1e-14 * (lab[i].norm() + other.norm());
    EXPECT_NEAR(found[i], spectral::deltaE2000(lab[i], other), allowed) << lab[i].transpose() << "\n"
                                                                        << other.transpose();
  }
  EXPECT_GT(greys, 100);
  EXPECT_LT(greys, 1000);
}

TEST_F(ColourDifferencesTest, HuesAreTakenTheShorterWay) {
  // Through every pair of hues, blues among them, at the chroma where the turn among blues counts.
  Colours lab;
  Colours given;
  const Eigen::Vector3d middle(50.0, 0.0, 0.0);
  for (int first = 0; first < 360; first += 5) {
    for (int second = 0; second < 360; second += 3) {
      const auto at = [&](int degrees) {
        const double angle = degrees * std::acos(-1.0) / 180.0;
        return Eigen::Vector3d(middle + 40.0 * Eigen::Vector3d(0.0, std::cos(angle), std::sin(angle)));
      };
      const Eigen::Vector3d other = at(second);
      const double y = (other[0] + 16.0) / 116.0;
      const Eigen::Array3d roots(y + other[1] / 500.0, y, y - other[2] / 200.0);
      lab.push_back(at(first));
      given.emplace_back(roots.cube().matrix().cwiseProduct(kWhite));
    }
  }
  const std::vector<double> found = measured(lab, given);
  for (std::size_t i = 0; i < lab.size(); ++i) {
    const Eigen::Vector3d other = spectral::lab(given[i], kWhite);
    if (std::abs(lab[i].tail<2>().dot(other.tail<2>()) + 1600.0) < 1e-9) {
      continue;  // opposite but for rounding: the formula jumps there
    }
    EXPECT_NEAR(found[i], spectral::deltaE2000(lab[i], other), 1e-10) << lab[i].transpose() << "\n"
                                                                      << other.transpose();
  }
}

TEST_F(ColourDifferencesTest, EachInstructionSetAndAnyCountGiveTheSameBits) {
  const Pairs pairs;
  const Colours lab = pairs.wantedLab();
  const std::vector<double> expected = measured(lab, pairs.given);
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(measured({lab[i]}, {pairs.given[i]}).front(), expected[i]);
  }
  const std::int64_t all = instructionSets();
  for (int bit = 0; bit < 63; ++bit) {
    if ((all >> bit & 1) != 0) {
      allowInstructionSets(std::int64_t{1} << bit);
      EXPECT_EQ(measured(lab, pairs.given), expected) << bit;
    }
  }
}

TEST_F(ColourDifferencesTest, WhatIsNoNumberIsInfinitelyFar) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const double endless = std::numeric_limits<double>::infinity();
  const Colours lab(5, Eigen::Vector3d(50.0, 0.0, 0.0));
  const Colours given = {
      {none, 1.0, 1.0}, {1.0, endless, 1.0}, {0.0, 0.0, -endless}, {0.1, 0.2, 0.1}, {1.0, 1.0, none}};
  const std::vector<double> found = measured(lab, given);
  for (const std::size_t i : {0, 1, 2, 4}) {
    EXPECT_EQ(found[i], endless) << i;
  }
  EXPECT_LT(found[3], 100.0);
  EXPECT_EQ(measured({{none, 0.0, 0.0}}, {kWhite}).front(), endless);
}

TEST_F(ColourDifferencesTest, CountsMustMatch) {
  std::vector<double> result(2);
  const ColourDifferences differences(Eigen::Matrix3d::Identity(), kWhite);
  EXPECT_THROW(differences.measure(Colours(2, kWhite), Colours(1, kWhite), result), spectral::InputError);
  EXPECT_THROW(differences.measure(Colours(3, kWhite), Colours(3, kWhite), result), spectral::InputError);
  differences.measure({}, {}, {});
}

}  // namespace
}  // namespace metamer::sip
