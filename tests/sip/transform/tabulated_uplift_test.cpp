// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/tabulated_uplift.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "metamer/sip/scene_uplift.h"
#include "sip/transform/transform_fixture.h"

namespace metamer::sip {
namespace {

using Eigen::Vector3d;
using spectral::testLibrary;

/// Colours of Rec.709, of wider ranges, and of none that is real.
std::vector<Vector3d> colours() {
  std::mt19937 random(11);
  std::vector<Vector3d> all;
  for (int i = 0; i < 6000; ++i) {
    Vector3d rgb{unitRandom(random), unitRandom(random), unitRandom(random)};
    if (i % 4 == 1) {
      rgb = rgb.cwiseProduct(rgb).cwiseProduct(rgb);  // saturated ones
    } else if (i % 16 == 2) {
      rgb -= Vector3d::Constant(0.2);
    }
    all.push_back(rgb / std::max(rgb.cwiseAbs().maxCoeff(), 1e-3));
  }
  return all;
}

std::vector<double> numbersOf(const std::vector<Vector3d>& colours) {
  std::vector<double> numbers;
  for (const Vector3d& colour : colours) {
    numbers.insert(numbers.end(), colour.begin(), colour.end());
  }
  return numbers;
}

Eigen::MatrixXd spectraOf(const spectral::Uplift& uplift, const std::vector<Vector3d>& colours) {
  const auto bands = static_cast<Eigen::Index>(uplift.wavelengthsNm().size());
  Eigen::MatrixXd spectra(bands, static_cast<Eigen::Index>(colours.size()));
  uplift.spectra(numbersOf(colours), {spectra.data(), static_cast<std::size_t>(spectra.size())});
  return spectra;
}

std::unique_ptr<spectral::Uplift> tableOf(const std::string& name) {
  return tabulated(makeUplift(name, testLibrary()), testLibrary().colourSpace("ACES2065-1").linear);
}

TEST(TabulatedUplift, DeviatesByAboutAHalfFloatsStep) {
  for (const char* const name : {"smooth", "natural"}) {
    const auto exact = makeUplift(name, testLibrary());
    const auto table = tableOf(name);
    const std::vector<Vector3d> all = colours();
    const Eigen::MatrixXd difference = spectraOf(*table, all) - spectraOf(*exact, all);
    std::vector<double> largest;
    for (Eigen::Index k = 0; k < difference.cols(); ++k) {
      largest.push_back(difference.col(k).cwiseAbs().maxCoeff());
    }
    std::sort(largest.begin(), largest.end());
    const double p99 = largest[largest.size() * 99 / 100];
    std::printf("[ table ] %s: median %.1e, p99 %.1e, largest %.1e\n", name, largest[largest.size() / 2], p99,
                largest.back());
    // A step of half floats just below 1 is 4.9e-4; components are at most 1 here.
    EXPECT_LE(p99, 4e-4) << name;
    EXPECT_LE(largest.back(), 1.5e-3) << name;
  }
}

TEST(TabulatedUplift, MeetsTheColourAndGreysExactly) {
  const auto exact = makeUplift("natural", testLibrary());
  const auto table = tableOf("natural");
  // Sums over the spectrum that give the colour: of any spectra that were interpolated alike.
  std::vector<Vector3d> all = colours();
  all.resize(2000);
  const Eigen::MatrixXd spectra = spectraOf(*exact, all);
  Eigen::Matrix3Xd rgb(3, static_cast<Eigen::Index>(all.size()));
  for (std::size_t k = 0; k < all.size(); ++k) {
    rgb.col(static_cast<Eigen::Index>(k)) = all[k];
  }
  const Eigen::MatrixXd rgbFromSpectrum = spectra.transpose().colPivHouseholderQr().solve(rgb.transpose()).transpose();
  ASSERT_LE((rgbFromSpectrum * spectra - rgb).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LE((rgbFromSpectrum * spectraOf(*table, all) - rgb).cwiseAbs().maxCoeff(), 1e-6);

  const std::vector<Vector3d> greys = {Vector3d::Zero(), Vector3d::Ones(), Vector3d::Constant(0.18),
                                       Vector3d::Constant(7.5), Vector3d::Constant(-0.1)};
  EXPECT_LE((spectraOf(*table, greys) - spectraOf(*exact, greys)).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(TabulatedUplift, OutsideItsPlaneColoursAreSolved) {
  const auto exact = makeUplift("natural", testLibrary());
  const auto table = tableOf("natural");
  const std::vector<Vector3d> outside = {{1, -1, 0}, {-1, -1, -1}, {0, 0, -0.3}, {1e-30, -1e-30, 0}};
  EXPECT_EQ(spectraOf(*table, outside), spectraOf(*exact, outside));
  // The corners of Rec.709 and what lies between them stay within.
  const std::vector<Vector3d> corners = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}};
  EXPECT_LE((spectraOf(*table, corners) - spectraOf(*exact, corners)).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(TabulatedUplift, ManyThreadsGetTheSameSpectra) {
  const std::vector<Vector3d> all = colours();
  const Eigen::MatrixXd wanted = spectraOf(*tableOf("smooth"), all);
  const auto shared = tableOf("smooth");
  std::vector<Eigen::MatrixXd> found(4);
  std::vector<std::thread> threads;
  threads.reserve(found.size());
  for (Eigen::MatrixXd& own : found) {
    threads.emplace_back([&] { own = spectraOf(*shared, all); });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (const Eigen::MatrixXd& own : found) {
    EXPECT_EQ(own, wanted);
  }
}

}  // namespace
}  // namespace metamer::sip
