// SPDX-License-Identifier: Apache-2.0
#include "inverse/most_probable.h"

#include <Eigen/Dense>
#include <utility>

namespace metamer::skin {
namespace {

constexpr int kMostRounds = 25;
constexpr double kStepOfDeviation = 0.05;
constexpr double kEnough = 1e-3;

}  // namespace

MostProbable::MostProbable(const SkinPrior& prior, Colour colour)
    : m_colour(std::move(colour)),
      m_mean(prior.mean),
      m_step(kStepOfDeviation * prior.standardDeviation),
      m_lowest(coordinatesOf({0, 0, kThinnestEpidermisUm, 0, 0})),
      m_highest(highestCoordinates()),
      m_precision(prior.covariance().inverse()) {}

MostProbable::Jacobian MostProbable::slope(const SkinCoordinates& at, const Eigen::Vector3d& colour) const {
  Jacobian result;
  for (Eigen::Index i = 0; i < 5; ++i) {
    SkinCoordinates moved = at;
    const double step = at[i] + m_step[i] > m_highest[i] ? -m_step[i] : m_step[i];
    moved[i] += step;
    result.col(i) = (m_colour(moved) - colour) / step;
  }
  return result;
}

double MostProbable::cost(const SkinCoordinates& at, const Eigen::Vector3d& difference, double perNoise) const {
  const SkinCoordinates away = at - m_mean;
  return (difference * perNoise).squaredNorm() + away.dot(m_precision * away);
}

SkinCoordinates MostProbable::of(const Eigen::Vector3d& rgb, const SkinCoordinates& start) const {
  const double perNoise = 1 / (kColourNoise * rgb.mean());
  SkinCoordinates at = start;
  Eigen::Vector3d colour = m_colour(at);
  double now = cost(at, colour - rgb, perNoise);
  double damping = 1e-3;
  Jacobian slope = this->slope(at, colour) * perNoise;
  for (int round = 0; round < kMostRounds; ++round) {
    Eigen::Matrix<double, 5, 5> curvature = slope.transpose() * slope + m_precision;
    SkinCoordinates downhill = -(slope.transpose() * (colour - rgb) * perNoise + m_precision * (at - m_mean));
    for (Eigen::Index i = 0; i < 5; ++i) {
      const bool leaves = (at[i] <= m_lowest[i] && downhill[i] < 0) || (at[i] >= m_highest[i] && downhill[i] > 0);
      if (leaves) {
        curvature.row(i).setZero();
        curvature.col(i).setZero();
        curvature(i, i) = 1;
        downhill[i] = 0;
      }
      curvature(i, i) *= 1 + damping;
    }
    const SkinCoordinates wanted = at + curvature.ldlt().solve(downhill);
    const SkinCoordinates next = wanted.cwiseMax(m_lowest).cwiseMin(m_highest);
    const Eigen::Vector3d nextColour = m_colour(next);
    const double then = cost(next, nextColour - rgb, perNoise);
    if (!(then < now)) {
      damping *= 10;
      if (damping > 1e6) {
        break;
      }
      continue;
    }
    const bool isEnough = now - then < kEnough * (1 + then);
    at = next;
    colour = nextColour;
    now = then;
    damping = std::max(damping / 10, 1e-6);
    if (isEnough) {
      break;
    }
    slope = this->slope(at, colour) * perNoise;
  }
  return at;
}

}  // namespace metamer::skin
