// SPDX-License-Identifier: Apache-2.0
#include "storage/line_search.h"

#include <Eigen/QR>
#include <algorithm>

namespace metamer::spectral {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Of the largest gradient: below it none is worth following.
constexpr double kNothing = 1e-10;
/// Rounds of moving lines.
constexpr int kRounds = 6;
/// A move must help by more than rounding.
constexpr double kGain = 1e-9;

VectorXd solved(const MatrixXd& matrix, const VectorXd& target, const std::vector<Index>& columns) {
  return MatrixXd(matrix(Eigen::all, columns)).colPivHouseholderQr().solve(target);
}

}  // namespace

VectorXd nonNegative(const MatrixXd& matrix, const VectorXd& target) {
  const Index size = matrix.cols();
  VectorXd found = VectorXd::Zero(size);
  if (size == 0) {
    return found;
  }
  std::vector<Index> free;
  const double largest = (matrix.transpose() * target).cwiseAbs().maxCoeff();
  // Each round frees a column and most keep it; the bound is for rounding alone.
  for (Index round = 0; round < 4 * size; ++round) {
    VectorXd gradient = matrix.transpose() * (target - matrix * found);
    for (const Index k : free) {
      gradient[k] = -1;
    }
    Index best = 0;
    if (gradient.maxCoeff(&best) <= kNothing * largest) {
      break;
    }
    free.push_back(best);
    for (VectorXd next = solved(matrix, target, free);; next = solved(matrix, target, free)) {
      // As far towards it as nothing falls below 0; what falls there is held.
      double step = 1;
      for (Index k = 0; k < next.size(); ++k) {
        const double now = found[free[static_cast<std::size_t>(k)]];
        if (next[k] <= 0) {
          step = std::min(step, now / std::max(now - next[k], 1e-300));
        }
      }
      for (Index k = 0; k < next.size(); ++k) {
        double& value = found[free[static_cast<std::size_t>(k)]];
        value = step >= 1 ? next[k] : std::max(0.0, value + step * (next[k] - value));
      }
      if (step >= 1) {
        break;
      }
      const double most = found.maxCoeff();
      std::erase_if(free, [&](Index k) {
        const bool isHeld = found[k] <= 1e-14 * most;
        found[k] = isHeld ? 0 : found[k];
        return isHeld;
      });
      if (free.empty()) {
        break;
      }
    }
  }
  return found;
}

HatsAndLines fitLines(const MatrixXd& seenHats, const MatrixXd& seen, const VectorXd& target, int lineCount) {
  const VectorXd sizes = seen.colwise().norm().cwiseMax(1e-12);
  const auto withLines = [&](const std::vector<int>& lines) {
    MatrixXd all(seen.rows(), seenHats.cols() + static_cast<Index>(lines.size()));
    all.leftCols(seenHats.cols()) = seenHats;
    for (std::size_t k = 0; k < lines.size(); ++k) {
      all.col(seenHats.cols() + static_cast<Index>(k)) = seen.col(lines[k]);
    }
    const VectorXd found = nonNegative(all, target);
    HatsAndLines fit;
    fit.hats = found.head(seenHats.cols());
    fit.powers = found.tail(static_cast<Index>(lines.size()));
    fit.lines = lines;
    fit.residual = (target - all * found).norm();
    return fit;
  };
  const auto rest = [&](const HatsAndLines& fit) -> VectorXd {
    VectorXd left = target - seenHats * fit.hats;
    for (std::size_t k = 0; k < fit.lines.size(); ++k) {
      left -= fit.powers[static_cast<Index>(k)] * seen.col(fit.lines[k]);
    }
    return left;
  };
  HatsAndLines best = withLines({});
  for (int added = 0; added < lineCount; ++added) {
    VectorXd explained = (seen.transpose() * rest(best)).cwiseQuotient(sizes);
    for (const int line : best.lines) {
      explained[line] = -1;
    }
    Index place = 0;
    explained.maxCoeff(&place);
    std::vector<int> lines = best.lines;
    lines.push_back(static_cast<int>(place));
    best = withLines(lines);
    bool isMoving = true;
    for (int round = 0; round < kRounds && isMoving; ++round) {
      isMoving = false;
      for (std::size_t k = 0; k < best.lines.size(); ++k) {
        for (const int move : {-8, -3, -1, 1, 3, 8}) {
          std::vector<int> moved = best.lines;
          moved[k] += move;
          if (moved[k] < 0 || moved[k] >= seen.cols() || std::count(moved.begin(), moved.end(), moved[k]) > 1) {
            continue;
          }
          HatsAndLines fit = withLines(moved);
          if (fit.residual < best.residual * (1 - kGain)) {
            best = std::move(fit);
            isMoving = true;
          }
        }
      }
    }
  }
  return best;
}

}  // namespace metamer::spectral
