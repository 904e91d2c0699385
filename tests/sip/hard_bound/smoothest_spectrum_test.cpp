// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/smoothest_spectrum.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cstdio>

#include "sip/sip_fixture.h"

namespace metamer::sip {
namespace {

using Solver = SmoothestSpectrumSolver;

/// Course notes, eq. 5.2-5.4: seven bands, 400 ... 700 nm every 50 nm, under a light of 6500 K.
Eigen::Matrix3Xd workedWeights() {
  Eigen::Matrix<double, 7, 3> weights;
  weights << 0.008, 0, 0.031,  //
      0.183, 0.02, 0.835,      //
      0.003, 0.165, 0.124,     //
      0.214, 0.476, 0.004,     //
      0.479, 0.275, 0,         //
      0.115, 0.042, 0,         //
      0.004, 0.001, 0;
  return weights.transpose();
}
const Eigen::Vector3d kWorkedTristimulus(0.311, 0.197, 0.284);

/// How far a spectrum is from the Karush-Kuhn-Tucker conditions, each part relative to the size of what it adds up.
struct Optimality {
  double residual = 0;      ///< of the tristimulus
  double beyondBounds = 0;  ///< how far the spectrum leaves them
  double stationarity = 0;  ///< gradient on the free bands that the three multipliers do not explain
  double wrongSign = 0;     ///< of the multipliers of held bands
};

/// Worked out from the spectrum alone, with dense algebra.
Optimality optimalityOf(const Solver& solver, const Eigen::VectorXd& spectrum, const Eigen::Vector3d& tristimulus,
                        bool bounded, const Eigen::VectorXd* prior = nullptr) {
  const Eigen::Index bands = spectrum.size();
  const Eigen::Matrix3Xd& weights = solver.weights();
  Optimality result;
  result.residual = (weights * spectrum - tristimulus).norm() / tristimulus.norm();
  result.beyondBounds = std::max({0.0, -spectrum.minCoeff(), bounded ? spectrum.maxCoeff() - 1.0 : 0.0});
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(bands);
  const Eigen::VectorXd deviation = prior != nullptr ? Eigen::VectorXd(spectrum - *prior) : spectrum;
  for (Eigen::Index b = 0; b + 1 < bands; ++b) {
    const double difference = deviation[b + 1] - deviation[b];
    gradient[b] -= difference;
    gradient[b + 1] += difference;
  }
  std::vector<Eigen::Index> free;
  for (Eigen::Index b = 0; b < bands; ++b) {
    if (spectrum[b] > 0.0 && (!bounded || spectrum[b] < 1.0)) {
      free.push_back(b);
    }
  }
  const double size = std::max(spectrum.cwiseAbs().maxCoeff(), deviation.cwiseAbs().maxCoeff());
  const Eigen::MatrixX3d columns = weights.transpose()(free, Eigen::all);
  const Eigen::Vector3d multipliers = columns.completeOrthogonalDecomposition().solve(gradient(free).eval());
  const Eigen::VectorXd leftOver = gradient - weights.transpose() * multipliers;
  for (Eigen::Index b = 0; b < bands; ++b) {
    if (spectrum[b] <= 0.0) {
      result.wrongSign = std::max(result.wrongSign, -leftOver[b] / size);
    } else if (bounded && spectrum[b] >= 1.0) {
      result.wrongSign = std::max(result.wrongSign, leftOver[b] / size);
    } else {
      result.stationarity = std::max(result.stationarity, std::abs(leftOver[b]) / size);
    }
  }
  return result;
}

/// Fails where a spectrum is not the answer of its problem.
class OptimalityCheck {
 public:
  explicit OptimalityCheck(const std::string& name)
      : m_residual(name + ": tristimulus", 1e-9),
        m_bounds(name + ": bounds", 0.0),
        m_stationarity(name + ": stationarity", 1e-9),
        m_sign(name + ": signs of multipliers", 1e-9) {}
  void add(const Optimality& optimality) {
    m_residual.add(optimality.residual, 0.0);
    m_bounds.add(optimality.beyondBounds, 0.0);
    m_stationarity.add(optimality.stationarity, 0.0);
    m_sign.add(optimality.wrongSign, 0.0);
  }

 private:
  spectral::MaxDifference m_residual;
  spectral::MaxDifference m_bounds;
  spectral::MaxDifference m_stationarity;
  spectral::MaxDifference m_sign;
};

/// Moved a thousandth of the way to white: the domain that the engine keeps to.
Eigen::Vector3d drawnIn(const Eigen::Vector3d& tristimulus) {
  return 0.999 * tristimulus + Eigen::Vector3d::Constant(0.001 * tristimulus.sum() / 3.0);
}

TEST(SmoothestSpectrumTest, WorkedExample) {
  const Solver solver(workedWeights());
  const auto solution = solver.solve(kWorkedTristimulus);
  ASSERT_TRUE(solution);
  const Eigen::VectorXd printed{{0.3179, 0.3094, 0.1242, 0.1052, 0.3683, 0.4417, 0.4446}};
  std::printf("[ worked example ] tristimulus off by %.2g; spectrum",
              (solver.weights() * solution->reflectance - kWorkedTristimulus).cwiseAbs().maxCoeff());
  for (const double value : solution->reflectance) {
    std::printf(" %.4f", value);
  }
  std::printf("\n");
  EXPECT_LE((solver.weights() * solution->reflectance - kWorkedTristimulus).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LE((solution->reflectance - printed).cwiseAbs().maxCoeff(), 0.5e-4);
  EXPECT_TRUE(solution->active.empty());
  EXPECT_EQ(solution->reflectance, Eigen::VectorXd(solver.unconstrained() * kWorkedTristimulus));
}

TEST(SmoothestSpectrumTest, MeetsTheOptimalityConditions) {
  for (const char* const light : {"D65", "A", "HP1", "FL11"}) {
    for (const int bands : {16, 41, 81, 201, kConvergedBandCount}) {
      OptimalityCheck check(std::string(light) + " " + std::to_string(bands));
      const Solver solver(normalisedWeights(light, bands));
      int fellBack = 0;
      for (const Eigen::Vector3d& given : feasibleTristimuli(solver.weights(), 200)) {
        const Eigen::Vector3d tristimulus = drawnIn(given);
        const auto solution = solver.solve(tristimulus);
        ASSERT_TRUE(solution) << light << " " << bands << ": " << tristimulus.transpose();
        check.add(optimalityOf(solver, solution->reflectance, tristimulus, false));
        fellBack += solution->fellBack ? 1 : 0;
        for (int b = 0; b < bands; ++b) {
          ASSERT_EQ(solution->active.holds(b), solution->reflectance[b] == 0.0) << light << " " << bands << " " << b;
        }
      }
      EXPECT_LE(fellBack, 20) << light << " " << bands;
    }
  }
}

TEST(SmoothestSpectrumTest, UpperBound) {
  for (const char* const light : {"D65", "HP1"}) {
    for (const int bands : {41, 81}) {
      OptimalityCheck check(std::string("bounded ") + light + " " + std::to_string(bands));
      const Eigen::Matrix3Xd weights = normalisedWeights(light, bands);
      const Solver bounded(weights, Solver::UpperBound::One);
      const Solver unbounded(weights);
      int clamped = 0;
      for (int seed = 0; seed < 200; ++seed) {
        // Within the bounds, so that there is an answer, and near the most saturated colours of its lightness: 0 and 1
        // with two edges, drawn in a little.
        Eigen::VectorXd spectrum = Eigen::VectorXd::Constant(bands, seed % 2 == 0 ? 0.01 : 0.99);
        const int first = bands / 8 + seed * (bands / 2) / 200;
        spectrum.segment(first, bands / 8 + seed % (bands / 8)).setConstant(seed % 2 == 0 ? 0.99 : 0.01);
        const Eigen::Vector3d tristimulus = weights * spectrum;
        const auto solution = bounded.solve(tristimulus);
        ASSERT_TRUE(solution) << light << " " << bands << " " << seed;
        check.add(optimalityOf(bounded, solution->reflectance, tristimulus, true));
        clamped += std::any_of(solution->active.stretches.begin(), solution->active.stretches.end(),
                               [](const auto& stretch) { return stretch.atOne; })
                       ? 1
                       : 0;
        const auto free = unbounded.solve(tristimulus);
        ASSERT_TRUE(free);
        EXPECT_GE(roughness(solution->reflectance), roughness(free->reflectance) * (1 - 1e-9));
      }
      EXPECT_GT(clamped, 20) << light << " " << bands;
      // Twice white: no reflectance of at most 1.
      EXPECT_FALSE(bounded.solve(Eigen::Vector3d::Constant(2.0)));
      EXPECT_TRUE(unbounded.solve(Eigen::Vector3d::Constant(2.0)));
    }
  }
}

TEST(SmoothestSpectrumTest, Prior) {
  const Eigen::Matrix3Xd weights = normalisedWeights("D65", 81);
  const Solver solver(weights);
  OptimalityCheck check("prior");
  for (const spectral::DomainSamples& sample : samplesOf("colorchecker")) {
    const Eigen::VectorXd prior = atBandCentres(sample, 81);
    // A prior with the very tristimulus is its own answer.
    const auto same = solver.solve(weights * prior, &prior);
    ASSERT_TRUE(same);
    EXPECT_LE((same->reflectance - prior).cwiseAbs().maxCoeff(), 1e-12);
    for (const Eigen::Vector3d& given : feasibleTristimuli(weights, 10)) {
      const Eigen::Vector3d tristimulus = drawnIn(given);
      const auto solution = solver.solve(tristimulus, &prior);
      ASSERT_TRUE(solution);
      check.add(optimalityOf(solver, solution->reflectance, tristimulus, false, &prior));
    }
  }
}

TEST(SmoothestSpectrumTest, NothingWhereThereIsNoSpectrum) {
  for (const char* const light : {"D65", "HP1"}) {
    const Solver solver(normalisedWeights(light, 81));
    const std::vector<Eigen::Vector3d> beyond{{-1, 0, 0},   {0, 1, 0},     {1, 0, 0},
                                              {-1, -1, -1}, {1, 1, -1e-3}, {0, -1, 1}};
    for (const Eigen::Vector3d& tristimulus : beyond) {
      EXPECT_FALSE(solver.solve(tristimulus)) << light << ": " << tristimulus.transpose();
    }
  }
}

TEST(SmoothestSpectrumTest, BlackAndScale) {
  const Solver solver(normalisedWeights("D65", 81));
  const auto black = solver.solve(Eigen::Vector3d::Zero());
  ASSERT_TRUE(black);
  EXPECT_TRUE(black->reflectance.isZero(0.0));
  for (const Eigen::Vector3d& given : feasibleTristimuli(solver.weights(), 50)) {
    const auto one = solver.solve(drawnIn(given));
    const auto many = solver.solve(1048576.0 * drawnIn(given));
    ASSERT_TRUE(one && many);
    EXPECT_EQ(Eigen::VectorXd(1048576.0 * one->reflectance), many->reflectance);
  }
}

TEST(SmoothestSpectrumTest, GuessesDoNotChangeTheAnswer) {
  for (const char* const light : {"D65", "HP1", "FL11"}) {
    const Solver solver(normalisedWeights(light, 81));
    const std::vector<Eigen::Vector3d> tristimuli = feasibleTristimuli(solver.weights(), 100);
    std::vector<ActiveSet> guesses{{}};
    for (const Eigen::Vector3d& given : tristimuli) {
      const auto solution = solver.solve(drawnIn(given));
      ASSERT_TRUE(solution);
      for (const ActiveSet& guess : guesses) {
        const auto warm = solver.solve(drawnIn(given), nullptr, &guess);
        ASSERT_TRUE(warm);
        ASSERT_EQ(warm->reflectance, solution->reflectance) << light << ": " << given.transpose();
        ASSERT_EQ(warm->active, solution->active) << light << ": " << given.transpose();
      }
      guesses.push_back(between(solution->active, guesses.back()));
      guesses.push_back(solution->active);
    }
    // A guess that no answer has: every other band held.
    ActiveSet absurd;
    for (std::int16_t b = 0; b < 81; b += 2) {
      absurd.stretches.push_back({b, static_cast<std::int16_t>(b + 1), false});
    }
    for (const Eigen::Vector3d& given : tristimuli) {
      EXPECT_EQ(solver.solve(drawnIn(given), nullptr, &absurd)->reflectance, solver.solve(drawnIn(given))->reflectance);
    }
  }
}

TEST(SmoothestSpectrumTest, LinearPieceIsTheSolution) {
  for (const char* const light : {"D65", "HP1", "FL11"}) {
    const Solver solver(normalisedWeights(light, 81));
    const Eigen::MatrixX3d functionals = normalisedWeights("LED-RGB1", 81).transpose();
    ActiveSet latest;
    for (const Eigen::Vector3d& given : feasibleTristimuli(solver.weights(), 200)) {
      const Eigen::Vector3d tristimulus = drawnIn(given);
      const auto solution = solver.solve(tristimulus);
      ASSERT_TRUE(solution);
      const Eigen::Vector3d expected = functionals.transpose() * solution->reflectance;
      for (const ActiveSet* const guess : std::initializer_list<const ActiveSet*>{nullptr, &latest}) {
        const auto piece = solver.linearise(tristimulus, functionals, guess);
        ASSERT_TRUE(piece);
        ASSERT_EQ(piece->active, solution->active) << light << ": " << given.transpose();
        ASSERT_LE((piece->matrix * tristimulus - expected).cwiseAbs().maxCoeff(), 1e-9 * expected.maxCoeff())
            << light << ": " << given.transpose();
      }
      latest = solution->active;
    }
  }
}

TEST(SmoothestSpectrumTest, ForcingOnlyIsNeverSmoother) {
  for (const char* const light : {"D65", "A", "HP1", "FL11"}) {
    const Solver solver(normalisedWeights(light, 81));
    int same = 0;
    int rougher = 0;
    int failed = 0;
    const std::vector<Eigen::Vector3d> tristimuli = feasibleTristimuli(solver.weights(), 1000);
    for (const Eigen::Vector3d& given : tristimuli) {
      const auto exact = solver.solve(drawnIn(given));
      const auto forced = solver.solveByForcingOnly(drawnIn(given));
      ASSERT_TRUE(exact);
      if (!forced) {
        ++failed;
        continue;
      }
      const double best = roughness(exact->reflectance);
      const double other = roughness(forced->reflectance.cwiseMax(0.0));
      EXPECT_GE(other, best * (1 - 1e-8)) << light << ": " << given.transpose();
      ++(other > best * (1 + 1e-8) ? rougher : same);
    }
    std::printf("[ forcing only ] %s: %d of %zu the same spectrum, %d rougher, %d without\n", light, same,
                tristimuli.size(), rougher, failed);
    EXPECT_GT(same, 0) << light;
  }
}

}  // namespace
}  // namespace metamer::sip
