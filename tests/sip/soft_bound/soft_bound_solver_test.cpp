// SPDX-License-Identifier: Apache-2.0
#include "soft_bound/soft_bound_solver.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "sip/sip_fixture.h"
#include "sip/soft_bound/soft_bound_fixture.h"

namespace metamer::sip {
namespace {

using Eigen::Vector3d;

constexpr std::array<int, 5> kBandCounts = {16, 41, 81, 251, 401};
constexpr std::array<double, 3> kRelaxations = {0.0, 100.0, 0.5};
/// Daylight, lines, emitters with darkness between them, and next to one line alone.
constexpr std::array<const char*, 6> kLights = {"D65", "A", "HP1", "FL11", "LED-RGB1", "LPS"};

std::string labelOf(const char* light, int bands, double relaxation) {
  return std::string(light) + ", " + std::to_string(bands) + " bands, relaxation " + std::to_string(relaxation);
}

/// Newton's method has no cap in sight: it takes a few rounds, and this many at the very most.
constexpr int kMostRounds = 20;

TEST(SoftBoundSolverTest, MeetsTheOptimalityConditions) {
  for (const int bands : kBandCounts) {
    double missed = 0.0;
    double gradient = 0.0;
    int mostRounds = 0;
    double rounds = 0.0;
    int solves = 0;
    for (const char* const light : kLights) {
      for (const double relaxation : kRelaxations) {
        // Sodium's weights tell the eye's blue from its green by their last digits.
        if (relaxation == 0.0 && std::string(light) == "LPS") {
          continue;
        }
        const SoftBoundSolver solver(normalisedWeights(light, bands), relaxation);
        std::mt19937 random(7);
        for (const Vector3d& tristimulus : everyTristimulus(solver, bands > 100 ? 60 : 150)) {
          const double size = tristimulus.cwiseAbs().maxCoeff();
          for (const double priorSize : {0.0, 0.3 * size, 3.0 * size}) {
            const BandVector prior = randomPrior(solver, random, priorSize);
            const BandVector* const given = priorSize > 0.0 ? &prior : nullptr;
            const SoftBoundSolver::Solution solution = solver.solve(tristimulus, given);
            const double rounding = 1e-11 * solution.reflectance.cwiseAbs().maxCoeff();
            for (int b = 0; b < bands; ++b) {
              if (std::abs(solution.reflectance[b]) <= rounding) {
                continue;
              }
              ASSERT_EQ(solution.clamped[static_cast<std::size_t>(b)], solution.reflectance[b] < 0.0)
                  << labelOf(light, bands, relaxation) << ": " << tristimulus.transpose();
            }
            const Optimality found = optimalityOf(solver, relaxation, solution.reflectance, tristimulus, given);
            missed = std::max(missed, found.missed);
            gradient = std::max(gradient, found.gradient);
            ASSERT_LE(solution.rounds, kMostRounds)
                << labelOf(light, bands, relaxation) << ": " << tristimulus.transpose();
            mostRounds = std::max(mostRounds, solution.rounds);
            rounds += solution.rounds;
            ++solves;
          }
        }
      }
    }
    std::printf("[ soft bound ] %d bands: response within %.2g, gradient within %.2g; rounds %.2f, at most %d, of %d\n",
                bands, missed, gradient, rounds / solves, mostRounds, solves);
    EXPECT_LE(missed, 1e-11) << bands;
    EXPECT_LE(gradient, 1e-11) << bands;
  }
}

TEST(SoftBoundSolverTest, WhiteIsThePerfectReflector) {
  for (const int bands : {41, 81, 401}) {
    spectral::MaxDifference exact("white at " + std::to_string(bands) + " bands", 1e-12);
    spectral::MaxDifference relaxed("white, relaxed, at " + std::to_string(bands) + " bands", 1e-12);
    for (const char* const light : kLights) {
      const Eigen::Matrix3Xd weights = normalisedWeights(light, bands);
      const Eigen::VectorXd perfect = Eigen::VectorXd::Ones(bands);
      if (std::string(light) != "LPS") {
        exact.add(SoftBoundSolver(weights).solve(Vector3d::Ones()).reflectance, perfect);
      }
      relaxed.add(SoftBoundSolver(weights, 30.0).solve(Vector3d::Ones()).reflectance, perfect);
    }
  }
}

TEST(SoftBoundSolverTest, SideBySideAreTheSameBits) {
  std::mt19937 random(3);
  for (const int bands : {16, 81, 401}) {
    for (const double relaxation : kRelaxations) {
      const SoftBoundSolver solver(normalisedWeights("HP1", bands), relaxation);
      const std::vector<Vector3d> tristimuli = everyTristimulus(solver, 37);
      std::vector<BandVector> priors;
      std::vector<BandVector> spectra(tristimuli.size(), BandVector(bands));
      std::vector<SoftBoundSolver::Problem> problems(tristimuli.size());
      for (std::size_t k = 0; k < tristimuli.size(); ++k) {
        priors.push_back(randomPrior(solver, random, 0.3 * tristimuli[k].cwiseAbs().maxCoeff()));
      }
      for (std::size_t k = 0; k < tristimuli.size(); ++k) {
        problems[k].tristimulus = tristimuli[k];
        problems[k].prior = k % 3 != 0 ? priors[k].data() : nullptr;
        problems[k].reflectance = spectra[k].data();
      }
      solver.solve(problems);
      int clampedCount = 0;
      for (std::size_t k = 0; k < tristimuli.size(); ++k) {
        const auto alone = solver.solve(tristimuli[k], k % 3 != 0 ? &priors[k] : nullptr);
        ASSERT_EQ(spectra[k], alone.reflectance) << bands << " bands, colour " << k;
        ASSERT_EQ(problems[k].clamped, alone.clamped);
        ASSERT_EQ(problems[k].rounds, alone.rounds);
        clampedCount += alone.rounds > 0 ? 1 : 0;
      }
      EXPECT_GT(clampedCount, 10);
    }
  }
}

TEST(SoftBoundSolverTest, DerivativeAgainstDifferences) {
  std::mt19937 random(11);
  for (const int bands : {16, 81, 401}) {
    for (const double relaxation : kRelaxations) {
      const SoftBoundSolver solver(normalisedWeights("FL11", bands), relaxation);
      BandTriple priorSlope(bands, 3);
      for (Eigen::Index k = 0; k < 3; ++k) {
        priorSlope.col(k) = randomPrior(solver, random, 0.2);
      }
      int unlike = 0;
      int clampedCount = 0;
      const std::vector<Vector3d> tristimuli = everyTristimulus(solver, 60);
      for (const bool withPrior : {false, true}) {
        const auto solve = [&](const Vector3d& c) {
          const BandVector prior = priorSlope * c;
          return solver.solve(c, withPrior ? &prior : nullptr);
        };
        for (const Vector3d& tristimulus : tristimuli) {
          const SoftBoundSolver::Solution middle = solve(tristimulus);
          clampedCount += middle.clamped.any() ? 1 : 0;
          const BandTriple slope = solver.derivative(middle.clamped, withPrior ? &priorSlope : nullptr);
          const Vector3d step = 1e-6 * tristimulus.norm() * Vector3d(1, -2, 3);
          const BandVector change = solve(tristimulus + step).reflectance - solve(tristimulus - step).reflectance;
          const double size = change.cwiseAbs().maxCoeff();
          unlike += (change - 2.0 * slope * step).cwiseAbs().maxCoeff() > 1e-6 * size ? 1 : 0;
          // Homogeneous: the derivative gives the answer itself.
          EXPECT_LE((slope * tristimulus - middle.reflectance).cwiseAbs().maxCoeff(),
                    1e-10 * middle.reflectance.cwiseAbs().maxCoeff());
        }
      }
      // A band that is clamped on one side of the step and free on the other is a kink; the fixture has some colours
      // at one, a tenth of all.
      EXPECT_LE(unlike, static_cast<int>(2 * tristimuli.size()) / 5) << bands << " " << relaxation;
      EXPECT_GT(clampedCount, 20);
    }
  }
}

TEST(SoftBoundSolverTest, Homogeneous) {
  std::mt19937 random(5);
  for (const double relaxation : kRelaxations) {
    const SoftBoundSolver solver(normalisedWeights("HP1", 81), relaxation);
    for (const Vector3d& tristimulus : everyTristimulus(solver, 60)) {
      const BandVector prior = randomPrior(solver, random, 0.3 * tristimulus.cwiseAbs().maxCoeff());
      const BandVector expected = solver.solve(tristimulus, &prior).reflectance;
      const double size = expected.cwiseAbs().maxCoeff();
      for (const int stop : {-100, -1, 1, 100}) {
        const BandVector scaledPrior = std::ldexp(1.0, stop) * prior;
        const BandVector scaled = solver.solve(std::ldexp(1.0, stop) * tristimulus, &scaledPrior).reflectance;
        ASSERT_EQ(scaled, BandVector(std::ldexp(1.0, stop) * expected)) << tristimulus.transpose();
      }
      for (const double exposure : {1e-30, 0.3, 1e30}) {
        const BandVector scaledPrior = exposure * prior;
        const BandVector scaled = solver.solve(exposure * tristimulus, &scaledPrior).reflectance / exposure;
        EXPECT_LE((scaled - expected).cwiseAbs().maxCoeff(), 1e-11 * size) << tristimulus.transpose();
      }
    }
    const BandVector none = BandVector::Zero(81);
    EXPECT_TRUE(solver.solve(Vector3d::Zero(), &none).reflectance.isZero(0.0));
  }
}

TEST(SoftBoundSolverTest, PaysForWhatLiesBelowZero) {
  // A colour beyond the locus is met by going below zero, but less than the spectrum without a bound does; one that a
  // smooth reflectance can make is left alone.
  const SoftBoundSolver solver(normalisedWeights("D65", 81));
  const Vector3d outside(0.2, 1.0, 0.0);
  const BandVector free = solver.unclamped() * outside;
  const BandVector bound = solver.solve(outside).reflectance;
  EXPECT_LT(bound.minCoeff(), 0.0);
  EXPECT_LT(bound.cwiseMin(0.0).squaredNorm(), 0.2 * free.cwiseMin(0.0).squaredNorm());
  const Vector3d inside(0.5, 0.45, 0.4);
  EXPECT_EQ(solver.solve(inside).reflectance, BandVector(solver.unclamped() * inside));
  EXPECT_EQ(solver.solve(inside).rounds, 0);
}

}  // namespace
}  // namespace metamer::sip
