// SPDX-License-Identifier: Apache-2.0
#include "captures/chart_arrangement.h"

#include <array>
#include <cmath>
#include <vector>

#include "metamer/spectral/formatted.h"

namespace metamer::stage {
namespace {

/// A channel this much darker than the chart's brightest tells nothing.
constexpr double kDarkChannel = 0.05;
/// The floor of a fit's weights: absolute residuals.
constexpr double kAbsolute = 1e3;
/// From this misfit on other arrangements are tried.
constexpr double kSuspicious = 0.12;
/// Another arrangement must halve the misfit.
constexpr double kClearlyBetter = 0.5;

struct Candidate {
  bool mirroredAcross = false;
  bool mirroredDown = false;
  double columns = 0;
  double rows = 0;
};

std::string wordsOf(const Candidate& candidate) {
  if (candidate.mirroredAcross && candidate.mirroredDown) {
    return "turned by 180 degrees";
  }
  if (candidate.mirroredAcross || candidate.mirroredDown) {
    return candidate.mirroredAcross ? "mirrored left to right" : "mirrored top to bottom";
  }
  const double by = candidate.columns != 0 ? candidate.columns : candidate.rows;
  return spectral::formatted("shifted by %g %s", std::abs(by), candidate.columns != 0 ? "column" : "row") +
         (candidate.columns != 0 ? (by > 0 ? " to the right" : " to the left") : (by > 0 ? " down" : " up"));
}

std::vector<Candidate> candidates() {
  std::vector<Candidate> all = {{true, false, 0, 0}, {false, true, 0, 0}, {true, true, 0, 0}};
  for (const double by : {1.0, 0.5, 0.25}) {
    for (const double sign : {1.0, -1.0}) {
      all.push_back({false, false, sign * by, 0});
      all.push_back({false, false, 0, sign * by});
    }
  }
  return all;
}

/// What each named patch would show: the patches under it, and which are wholly on the chart.
struct Moved {
  Eigen::MatrixXd bands;
  std::vector<Eigen::Index> patches;
};

Moved movedBy(const Candidate& candidate, const ChartExpectation& expectation) {
  Eigen::MatrixXi at = Eigen::MatrixXi::Constant(expectation.rows, expectation.columns, -1);
  for (std::size_t i = 0; i < expectation.cell.size(); ++i) {
    at(expectation.cell[i].y(), expectation.cell[i].x()) = static_cast<int>(i);
  }
  Moved moved;
  moved.bands.resize(expectation.bands.rows(), expectation.bands.cols());
  for (std::size_t i = 0; i < expectation.cell.size(); ++i) {
    const int column =
        candidate.mirroredAcross ? expectation.columns - 1 - expectation.cell[i].x() : expectation.cell[i].x();
    const int row = candidate.mirroredDown ? expectation.rows - 1 - expectation.cell[i].y() : expectation.cell[i].y();
    const double x = column + candidate.columns;
    const double y = row + candidate.rows;
    Eigen::RowVectorXd seen = Eigen::RowVectorXd::Zero(expectation.bands.cols());
    double share = 0;
    for (const double cellX : {std::floor(x), std::floor(x) + 1}) {
      for (const double cellY : {std::floor(y), std::floor(y) + 1}) {
        const double weight = (1 - std::abs(x - cellX)) * (1 - std::abs(y - cellY));
        const bool isOnChart = cellX >= 0 && cellY >= 0 && cellX < expectation.columns && cellY < expectation.rows;
        const int patch = isOnChart ? at(static_cast<int>(cellY), static_cast<int>(cellX)) : -1;
        if (weight > 0 && patch >= 0) {
          seen += weight * expectation.bands.row(patch);
          share += weight;
        }
      }
    }
    if (share > 1 - 1e-9) {
      moved.bands.row(static_cast<Eigen::Index>(moved.patches.size())) = seen;
      moved.patches.push_back(static_cast<Eigen::Index>(i));
    }
  }
  moved.bands.conservativeResize(static_cast<Eigen::Index>(moved.patches.size()), Eigen::NoChange);
  return moved;
}

}  // namespace

double misfitOf(const Eigen::MatrixXd& bands, const Eigen::Matrix3Xd& rgb) {
  const double brightest = rgb.maxCoeff();
  double left = 0;
  double all = 0;
  for (Eigen::Index channel = 0; channel < 3; ++channel) {
    const Eigen::VectorXd values = rgb.row(channel).transpose();
    const double top = values.maxCoeff();
    if (!(top > kDarkChannel * brightest)) {
      continue;
    }
    const ChannelFit fit = fitChannel(bands, values, kAbsolute * top);
    left += (fit.fitted - values).squaredNorm() / (top * top);
    all += (values.array() - values.mean()).square().sum() / (top * top);
  }
  return all > 0 ? std::sqrt(left / all) : 0;
}

Arrangement arrangementOf(const ChartExpectation& expectation, const Eigen::Matrix3Xd& rgb) {
  Arrangement best;
  best.asNamed = misfitOf(expectation.bands, rgb);
  best.arranged = best.asNamed;
  if (best.asNamed < kSuspicious || expectation.cell.empty()) {
    return best;
  }
  double least = kClearlyBetter * best.asNamed;
  for (const Candidate& candidate : candidates()) {
    const Moved moved = movedBy(candidate, expectation);
    if (moved.patches.size() < kFewestKnownPatches) {
      continue;
    }
    const double misfit = misfitOf(moved.bands, rgb(Eigen::all, moved.patches));
    if (misfit < least) {
      least = misfit;
      best.words = wordsOf(candidate);
      best.arranged = misfit;
    }
  }
  return best;
}

}  // namespace metamer::stage
