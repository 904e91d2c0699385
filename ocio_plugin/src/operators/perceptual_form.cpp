// SPDX-License-Identifier: Apache-2.0
#include "operators/perceptual_form.h"

#include <Eigen/Eigenvalues>

namespace metamer::ocio {
namespace {

/// Least eigenvalue of the form scaled to a unit diagonal.
constexpr double kLeastEigenvalue = 0.02;

}  // namespace

Eigen::Matrix3d perceptualForm(const std::function<Eigen::Vector3d(const Eigen::Vector3d& deviation)>& difference,
                               double step) {
  Eigen::Matrix3d slope;
  for (int axis = 0; axis < 3; ++axis) {
    slope.col(axis) = difference(step * Eigen::Vector3d::Unit(axis)) / step;
  }
  const Eigen::Matrix3d form = slope.transpose() * slope;
  const Eigen::Vector3d scale = form.diagonal().cwiseSqrt().cwiseMax(1e-12);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> scaled(scale.cwiseInverse().asDiagonal() * form *
                                                              scale.cwiseInverse().asDiagonal());
  const Eigen::Matrix3d& axes = scaled.eigenvectors();
  return scale.asDiagonal() * axes * scaled.eigenvalues().cwiseMax(kLeastEigenvalue).asDiagonal() * axes.transpose() *
         scale.asDiagonal();
}

}  // namespace metamer::ocio
