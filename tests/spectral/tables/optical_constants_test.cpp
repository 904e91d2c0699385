// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/optical_constants.h"

#include <gtest/gtest.h>

#include "spectral/fixture.h"

namespace metamer::spectral {
namespace {

constexpr auto kN = OpticalConstant::Refraction;
constexpr auto kK = OpticalConstant::Extinction;

double at(const std::string& text, OpticalConstant part, double nm, bool isYaml = false) {
  return opticalConstantFrom(text, isYaml, "ag.csv", part).at(nm);
}

TEST(OpticalConstantsTest, BlocksOfBoth) {
  const std::string text = "wl,n\n0.38,0.19\n0.55,0.06\n0.78,0.04\nwl,k\n0.38,2.0\n0.55,3.3\n0.78,5.3\n";
  EXPECT_EQ(at(text, kN, 550), 0.06);
  EXPECT_EQ(at(text, kK, 550), 3.3);
  EXPECT_EQ(at(text, kK, 900), 5.3);  // ends hold
}

TEST(OpticalConstantsTest, ColumnsUnitsAndSizes) {
  EXPECT_EQ(at("wavelength (nm);n;k\n380;0,19;2,0\n780;0,04;53\n", kK, 780), 53);  // no percent
  EXPECT_EQ(at("Wavelength, um\tn\tk\n0.3\t1.5\t0\n0.9\t1.5\t0\n", kN, 500), 1.5);
  EXPECT_EQ(at("380 2.0\n780 5.3\n", kK, 380), 2.0);  // unnamed: what is asked for
  EXPECT_EQ(at("0.38 2.0\n0.78 5.3\n", kN, 780), 5.3);
}

TEST(OpticalConstantsTest, Yaml) {
  const std::string text =
      "REFERENCES: \"P. B. Johnson\"\nDATA:\n  - type: tabulated nk\n    data: |\n        0.3 1.5 0.9\n        0.5 1.0 "
      "2.0\n        1.0 0.2 6.5\n";
  EXPECT_EQ(at(text, kN, 500, true), 1.0);
  EXPECT_EQ(at(text, kK, 1000, true), 6.5);
  const std::string apart =
      "DATA:\n  - type: tabulated n\n    data: |\n        0.3 1.5\n        0.9 1.4\n  - type: tabulated k\n    data: "
      "|\n"
      "        0.3 0.1\n        0.9 0.2\n";
  EXPECT_EQ(at(apart, kN, 900, true), 1.4);
  EXPECT_EQ(at(apart, kK, 900, true), 0.2);
}

TEST(OpticalConstantsTest, Refused) {
  const auto error = [](const std::string& text, OpticalConstant part, bool isYaml = false) {
    return errorOf([&] { opticalConstantFrom(text, isYaml, "ag.csv", part); });
  };
  EXPECT_EQ(error("nm,k\n380,1\n780,2\n", kN), "ag.csv: n 'k': is not among these columns; name one 'n' in the header");
  EXPECT_EQ(error("nm,a,b\n380,1,1\n780,2,2\n", kK),
            "ag.csv: k 'a, b': is not among these columns; name one 'k' in the header");
  EXPECT_EQ(
      error("DATA:\n  - type: formula 1\n    coefficients: 0 1\n", kN, true),
      "ag.csv: DATA.type 'formula 1': is no table; download the material's n and k as CSV, which is tabulated for "
      "every material");
  EXPECT_EQ(error("nm,n\n380,-1\n780,2\n", kN),
            "ag.csv:2: reflectance '-1': must not be negative; set measurement noise below zero to 0");
}

}  // namespace
}  // namespace metamer::spectral
