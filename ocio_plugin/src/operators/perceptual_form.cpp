// SPDX-License-Identifier: Apache-2.0
#include "operators/perceptual_form.h"

#include <Eigen/Eigenvalues>

namespace metamer::ocio {
namespace {

/// Least eigenvalue of the form scaled to a unit diagonal.
constexpr double kLeastEigenvalue = 0.02;

}  // namespace

Eigen::Matrix3d perceptualForm(const std::function<double(const Eigen::Vector3d& deviation)>& difference, double step) {
  const auto squared = [&](const Eigen::Vector3d& direction) {
    const double slope = difference(step * direction) / step;
    return slope * slope;
  };
  const Eigen::Matrix3d axis = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d form;
  for (int i = 0; i < 3; ++i) {
    form(i, i) = squared(axis.col(i));
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < i; ++j) {
      form(i, j) = form(j, i) = 0.25 * (squared(axis.col(i) + axis.col(j)) - squared(axis.col(i) - axis.col(j)));
    }
  }
  const Eigen::Vector3d scale = form.diagonal().cwiseSqrt().cwiseMax(1e-12);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> scaled(scale.cwiseInverse().asDiagonal() * form *
                                                              scale.cwiseInverse().asDiagonal());
  const Eigen::Matrix3d& axes = scaled.eigenvectors();
  return scale.asDiagonal() * axes * scaled.eigenvalues().cwiseMax(kLeastEigenvalue).asDiagonal() * axes.transpose() *
         scale.asDiagonal();
}

}  // namespace metamer::ocio
