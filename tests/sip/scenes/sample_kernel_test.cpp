// SPDX-License-Identifier: Apache-2.0
#include "scenes/sample_kernel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "scenes/weighted_sums.h"
#include "vector/instruction_sets.h"

namespace metamer::sip {
namespace {

/// Sets instruction sets back, so that no other test runs on less than there is.
class SampleKernelTest : public testing::Test {
 protected:
  ~SampleKernelTest() override { allowInstructionSets(0); }
};

/// Places near and far, one of them twice, in a number that no vector divides.
Eigen::ArrayX2d places() {
  Eigen::ArrayX2d places(67, 2);
  for (Eigen::Index i = 0; i < places.rows(); ++i) {
    const auto step = static_cast<double>(i);
    const double size = i % 5 == 0 ? 300.0 : i % 7 == 0 ? 1e-9 : 3.0;
    places.row(i) << size * std::sin(1.3 * step), size * std::cos(2.1 * step);
  }
  places.row(66) = places.row(1);
  return places;
}

TEST_F(SampleKernelTest, AgainstLongDouble) {
  const Eigen::ArrayX2d samples = places();
  const SampleKernel kernel(samples);
  for (const Eigen::Vector2d& place :
       {Eigen::Vector2d(0, 0), Eigen::Vector2d(0.3, -0.7), Eigen::Vector2d(samples.row(1)), Eigen::Vector2d(-40, 1),
        Eigen::Vector2d(1e9, -1e12)}) {
    const Eigen::MatrixX3d both = kernel.valuesAndSlopes(place);
    const Eigen::VectorXd alone = kernel.values(place);
    for (Eigen::Index i = 0; i < samples.rows(); ++i) {
      const long double dx = static_cast<long double>(samples(i, 0)) - place.x();
      const long double dy = static_cast<long double>(samples(i, 1)) - place.y();
      const long double t = std::sqrt(dx * dx + dy * dy);
      const long double fade = std::exp(-t);
      // Rounding of t, times t, is what an exponential makes of it; below 1e-300 nothing is asked.
      const auto near = [&](double value, long double expected) {
        const double allowed = 4e-16 * (4.0 + std::min(700.0, static_cast<double>(t)));
        return std::abs(value - static_cast<double>(expected)) <=
               allowed * std::abs(static_cast<double>(expected)) + 1e-290;
      };
      EXPECT_EQ(both(i, 0), alone[i]);
      EXPECT_TRUE(near(alone[i], (1 + t) * fade)) << i << ": " << alone[i] << " at " << static_cast<double>(t);
      EXPECT_TRUE(near(both(i, 1), dx * fade)) << i;
      EXPECT_TRUE(near(both(i, 2), dy * fade)) << i;
    }
  }
}

TEST_F(SampleKernelTest, EachInstructionSetGivesTheSameBits) {
  const SampleKernel kernel(places());
  const WeightedSums spectra(Eigen::MatrixXd::Random(84, 67));
  const Eigen::Vector2d place(0.4, -1.2);
  const Eigen::MatrixX3d weights = kernel.valuesAndSlopes(place);
  const Eigen::MatrixXd sums = spectra.of(weights);
  EXPECT_LE((sums.topRows(84) - spectra.spectra() * weights.topRows(67)).cwiseAbs().maxCoeff(), 1e-13);
  for (const Eigen::Index sets : {1, 2}) {
    EXPECT_EQ(Eigen::MatrixXd(spectra.of(weights.leftCols(sets))), Eigen::MatrixXd(sums.leftCols(sets)));
  }
  const std::int64_t all = instructionSets();
  for (int bit = 0; bit < 63; ++bit) {
    if ((all >> bit & 1) != 0) {
      allowInstructionSets(std::int64_t{1} << bit);
      EXPECT_EQ(Eigen::MatrixXd(kernel.valuesAndSlopes(place)), Eigen::MatrixXd(weights)) << bit;
      EXPECT_EQ(spectra.of(weights), sums) << bit;
    }
  }
}

}  // namespace
}  // namespace metamer::sip
