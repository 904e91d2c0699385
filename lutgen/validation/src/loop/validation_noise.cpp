// SPDX-License-Identifier: Apache-2.0
#include "loop/validation_noise.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "metamer/spectral/colorimetry.h"
#include "metamer/spectral_ref/measure.h"

namespace metamer::validation {

double intervalOfMean(const Eigen::Vector3d& lab, const std::vector<Eigen::Vector3d>& differences) {
  const auto count = static_cast<double>(differences.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& difference : differences) {
    mean += difference / count;
  }
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& difference : differences) {
    covariance += (difference - mean) * (difference - mean).transpose() / (count * (count - 1));
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance);
  const double quantile = spectral_ref::studentQuantile(0.975, count - 1);
  double widest = 0;
  for (int i = 0; i < 3; ++i) {
    const double length = quantile * std::sqrt(std::max(0.0, eigen.eigenvalues()[i]));
    widest = std::max(widest, spectral::deltaE2000(lab, lab + length * eigen.eigenvectors().col(i)));
  }
  return widest;
}

}  // namespace metamer::validation
