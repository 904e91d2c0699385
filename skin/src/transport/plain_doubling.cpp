// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Dense>
#include <cmath>

#include "metamer/skin/layered_albedo.h"
#include "metamer/spectral/argument_checks.h"
#include "transport/layer_checks.h"

namespace metamer::skin {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Gauss points of 0 ... 1, from the eigenvalues of the Jacobi matrix (Golub and Welsch 1969).
struct Quadrature {
  VectorXd cosine;
  VectorXd weight;

  explicit Quadrature(int count) {
    MatrixXd jacobi = MatrixXd::Zero(count, count);
    for (int i = 1; i < count; ++i) {
      jacobi(i, i - 1) = jacobi(i - 1, i) = i / std::sqrt(4.0 * i * i - 1);
    }
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(jacobi);
    cosine = (eigen.eigenvalues().array() + 1) / 2;
    weight = eigen.eigenvectors().row(0).array().square().matrix().transpose();
  }
};

struct Slab {
  MatrixXd reflection;
  MatrixXd transmission;
};

/// Phase function between the directions: forward (same hemisphere) and back, delta-M scaled.
struct Phase {
  MatrixXd forward;
  MatrixXd back;
};

Phase phaseOf(const Quadrature& at, double anisotropy) {
  const auto count = at.cosine.size();
  const Eigen::Index moments = 2 * count;
  const double peak = std::pow(anisotropy, static_cast<double>(moments));
  Phase phase{MatrixXd::Zero(count, count), MatrixXd::Zero(count, count)};
  VectorXd before = VectorXd::Zero(count);
  VectorXd value = VectorXd::Ones(count);
  for (Eigen::Index k = 0; k < moments; ++k) {
    const auto order = static_cast<double>(k);
    const double share = (std::pow(anisotropy, order) - peak) / (1 - peak) * (2 * order + 1);
    phase.forward += share * value * value.transpose();
    phase.back += (k % 2 == 0 ? share : -share) * value * value.transpose();
    const VectorXd next = ((2 * order + 1) * at.cosine.array() * value.array() - order * before.array()) / (order + 1);
    before = value;
    value = next;
  }
  return phase;
}

Slab doubled(const Quadrature& at, const LayerOptics& layers, double absorption, double thickness) {
  const auto count = at.cosine.size();
  const MatrixXd identity = MatrixXd::Identity(count, count);
  if (thickness == 0) {
    return {MatrixXd::Zero(count, count), identity};
  }
  const double scattering = layers.scattering * (1 - std::pow(layers.anisotropy, 2.0 * static_cast<double>(count)));
  const Phase phase = phaseOf(at, layers.anisotropy);
  const VectorXd perCosine = at.cosine.cwiseInverse();
  const MatrixXd scatter = scattering / 2 * perCosine.asDiagonal() * phase.forward * at.weight.asDiagonal();
  const MatrixXd loss = MatrixXd(((absorption + scattering) * perCosine).asDiagonal()) - scatter;
  const MatrixXd back = scattering / 2 * perCosine.asDiagonal() * phase.back * at.weight.asDiagonal();

  constexpr double kThin = 1e-4;
  constexpr int kDeepest = 60;
  double step = std::isfinite(thickness) ? thickness : 1e6 / (absorption + scattering);
  int doublings = 0;
  for (; doublings < kDeepest && step * (absorption + scattering) / at.cosine.minCoeff() > kThin; ++doublings) {
    step /= 2;
  }
  // The midpoint rule over the thin layer.
  MatrixXd implicit(2 * count, 2 * count);
  MatrixXd explicitly(2 * count, 2 * count);
  implicit << identity + step / 2 * loss, -step / 2 * back, -step / 2 * back, identity + step / 2 * loss;
  explicitly << identity - step / 2 * loss, step / 2 * back, step / 2 * back, identity - step / 2 * loss;
  const MatrixXd out = implicit.partialPivLu().solve(explicitly);
  Slab slab{out.bottomLeftCorner(count, count), out.topLeftCorner(count, count)};
  for (int i = 0; i < doublings; ++i) {
    const MatrixXd through =
        slab.transmission * (identity - slab.reflection * slab.reflection).partialPivLu().inverse();
    slab.reflection += through * slab.reflection * slab.transmission;
    slab.transmission = through * slab.transmission;
  }
  return slab;
}

}  // namespace

double layeredAlbedoByPlainDoubling(const LayerOptics& layers, int streamsPerHemisphere) {
  requireLayers(layers);
  spectral::requireWithin("streams per hemisphere", streamsPerHemisphere, 2, 32);
  const Quadrature at(streamsPerHemisphere);
  const Slab epidermis = doubled(at, layers, layers.epidermisAbsorption, layers.epidermisThicknessCm);
  const MatrixXd dermis = doubled(at, layers, layers.dermisAbsorption, layers.dermisThicknessCm).reflection;
  const MatrixXd identity = MatrixXd::Identity(dermis.rows(), dermis.cols());
  const VectorXd light = VectorXd::Ones(dermis.rows());
  const VectorXd below = dermis * (epidermis.transmission * light);
  const VectorXd up = (identity - dermis * epidermis.reflection).partialPivLu().solve(below);
  const VectorXd out = epidermis.reflection * light + epidermis.transmission * up;
  return 2 * at.weight.cwiseProduct(at.cosine).dot(out);
}

}  // namespace metamer::skin
