// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/panel_linearity.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/input_error.h"

namespace metamer::stage {
namespace {

using spectral::InputError;

constexpr std::size_t kFewestDrives = 3;
/// Signals below this share of the largest are noise to a logarithm or a direction.
constexpr double kDim = 0.01;

Eigen::Vector2d straightLine(const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  Eigen::MatrixX2d system(x.size(), 2);
  system << x, Eigen::VectorXd::Ones(x.size());
  return system.colPivHouseholderQr().solve(y);
}

}  // namespace

PanelLinearity judgeLinearity(const DriveSeries& series) {
  spectral::requireAsMany("colours of a series", series.rgb.cols(), "its drives",
                          static_cast<std::int64_t>(series.drives.size()));
  std::vector<double> different = series.drives;
  std::sort(different.begin(), different.end());
  different.erase(std::unique(different.begin(), different.end()), different.end());
  if (different.size() < kFewestDrives) {
    throw InputError("", "drives", std::to_string(different.size()), "must be at least three different ones");
  }
  Eigen::Index strongest = 0;
  series.rgb.rowwise().maxCoeff().maxCoeff(&strongest);
  const Eigen::VectorXd drives =
      Eigen::Map<const Eigen::VectorXd>(series.drives.data(), static_cast<Eigen::Index>(series.drives.size()));
  const Eigen::VectorXd signal = series.rgb.row(strongest).transpose();
  PanelLinearity result;
  const Eigen::Vector2d line = straightLine(drives, signal);
  result.gain = line[0];
  if (!(result.gain > 0)) {
    throw InputError("", "series", "", "does not rise with the drive; check the channel and the order of the drives");
  }
  const double largest = signal.maxCoeff();
  Eigen::Index worst = 0;
  result.deviation = (signal - (drives * line[0]).array().matrix() - Eigen::VectorXd::Constant(drives.size(), line[1]))
                         .cwiseAbs()
                         .maxCoeff(&worst) /
                     largest;
  result.worstDrive = drives[worst];

  // The black level where it was measured, else what the line says of it.
  Eigen::Index lowest = 0;
  const double lowestDrive = drives.minCoeff(&lowest);
  result.black = lowestDrive == 0 ? signal[lowest] : line[1];
  const Eigen::Vector3d blackRgb =
      lowestDrive == 0 ? Eigen::Vector3d(series.rgb.col(lowest)) : Eigen::Vector3d(Eigen::Vector3d::Zero());
  Eigen::Index top = 0;
  drives.maxCoeff(&top);
  const Eigen::Vector3d full = series.rgb.col(top) - blackRgb;
  std::vector<double> logDrives;
  std::vector<double> logSignals;
  for (Eigen::Index i = 0; i < drives.size(); ++i) {
    const double lit = signal[i] - (lowestDrive == 0 ? result.black : 0);
    if (drives[i] > 0 && lit > kDim * largest) {
      logDrives.push_back(std::log(drives[i]));
      logSignals.push_back(std::log(lit));
      const Eigen::Vector3d light = series.rgb.col(i) - blackRgb;
      const double cosine = light.dot(full) / std::max(light.norm() * full.norm(), 1e-300);
      result.hueDrift = std::max(result.hueDrift, std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi);
    }
  }
  if (logDrives.size() >= 2) {
    const auto count = static_cast<Eigen::Index>(logDrives.size());
    result.exponent = straightLine(Eigen::Map<const Eigen::VectorXd>(logDrives.data(), count),
                                   Eigen::Map<const Eigen::VectorXd>(logSignals.data(), count))[0];
  }
  return result;
}

}  // namespace metamer::stage
