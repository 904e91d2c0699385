// SPDX-License-Identifier: Apache-2.0
// Meng, Simon, Hanika and Dachsbacher 2015, "Physically meaningful rendering using tristimulus colours", Computer
// Graphics Forum 34(4), section 3.1: of all spectra that are nowhere negative and have the colour, the one with the
// least sum of squared differences of neighbours. Solved exactly by Goldfarb and Idnani's dual method (Mathematical
// Programming 27, 1983).
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "uplift/jakob_solver.h"
#include "uplift/methods.h"
#include "uplift/uplift_basis.h"

namespace metamer::spectral {
namespace {

constexpr double kNegative = 1e-12;  ///< of the largest component: rounding
constexpr int kMostRounds = 1000;    ///< a quarter of it was never seen
constexpr int kHalvings = 50;

class Meng : public Uplift {
 public:
  Meng(std::vector<double> wavelengthsNm, const UpliftWeights& weights, const Eigen::Matrix3d& xyzFromRgb)
      : Uplift(std::move(wavelengthsNm), xyzFromRgb), m_weights(weights) {
    const Eigen::Index size = weights.rows();
    Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(size, size);
    for (Eigen::Index i = 0; i + 1 < size; ++i) {
      hessian.block<2, 2>(i, i) += (Eigen::Matrix2d() << 1, -1, -1, 1).finished();
    }
    // The colour is held, so that its square adds a constant to what is minimised and makes it definite.
    hessian += weights * weights.transpose();
    m_inverse = hessian.llt().solve(Eigen::MatrixXd::Identity(size, size));
    m_smooth = m_inverse * weights * (weights.transpose() * m_inverse * weights).inverse();
  }

 private:
  /// The multipliers by which a step keeps to the constraints, and the step: of the colour and of bands at zero.
  struct Direction {
    Eigen::VectorXd multipliers;
    Eigen::VectorXd step;
  };

  Direction directionOf(Eigen::Index band, const std::vector<Eigen::Index>& held) const {
    const Eigen::Index size = m_inverse.rows();
    const auto count = static_cast<Eigen::Index>(held.size());
    Eigen::MatrixXd normals(size, 3 + count);  // times the inverse
    normals.leftCols<3>() = m_inverse * m_weights;
    for (Eigen::Index j = 0; j < count; ++j) {
      normals.col(3 + j) = m_inverse.col(held[static_cast<std::size_t>(j)]);
    }
    Eigen::MatrixXd system(3 + count, 3 + count);
    system.topRows<3>() = m_weights.transpose() * normals;
    Eigen::VectorXd right(3 + count);
    right.head<3>() = normals.leftCols<3>().row(band).transpose();
    for (Eigen::Index j = 0; j < count; ++j) {
      const Eigen::Index at = held[static_cast<std::size_t>(j)];
      system.row(3 + j) = normals.row(at);
      right[3 + j] = m_inverse(at, band);
    }
    Direction direction;
    direction.multipliers = system.ldlt().solve(right);
    direction.step = m_inverse.col(band) - normals * direction.multipliers;
    return direction;
  }

  /// Whether there is such a spectrum.
  bool solve(const Eigen::Vector3d& xyz, Eigen::VectorXd& spectrum) const {
    spectrum = m_smooth * xyz;
    const double tolerance = kNegative * xyz.cwiseAbs().maxCoeff();
    std::vector<Eigen::Index> held;
    std::vector<double> forces;
    for (int round = 0; round < kMostRounds;) {
      Eigen::Index band = 0;
      if (spectrum.minCoeff(&band) >= -tolerance) {
        spectrum = spectrum.cwiseMax(0.0);
        return true;
      }
      double force = 0;
      for (bool isMet = false; !isMet; ++round) {
        if (round >= kMostRounds) {
          return false;
        }
        const Direction direction = directionOf(band, held);
        // How far until a held band wants to go.
        double most = std::numeric_limits<double>::infinity();
        std::size_t leaving = 0;
        for (std::size_t j = 0; j < held.size(); ++j) {
          const double rate = direction.multipliers[3 + static_cast<Eigen::Index>(j)];
          if (rate > 0 && forces[j] / rate < most) {
            most = forces[j] / rate;
            leaving = j;
          }
        }
        const double gain = direction.step[band];
        const bool canMove = gain > 1e-10 * m_inverse(band, band);
        const double whole = canMove ? -spectrum[band] / gain : std::numeric_limits<double>::infinity();
        const double length = std::min(most, whole);
        if (!std::isfinite(length)) {
          return false;
        }
        if (canMove) {
          spectrum += length * direction.step;
        }
        for (std::size_t j = 0; j < held.size(); ++j) {
          forces[j] -= length * direction.multipliers[3 + static_cast<Eigen::Index>(j)];
        }
        force += length;
        isMet = whole <= most;
        if (!isMet) {
          held.erase(held.begin() + static_cast<std::ptrdiff_t>(leaving));
          forces.erase(forces.begin() + static_cast<std::ptrdiff_t>(leaving));
        }
      }
      held.push_back(band);
      forces.push_back(force);
      spectrum[band] = 0;
    }
    return false;
  }

  void spectrumOf(const Eigen::Vector3d& rgb, double* spectrum) const override {
    const Eigen::Vector3d xyz = xyzFromRgb() * rgb;
    Eigen::Map<Eigen::VectorXd> result(spectrum, m_inverse.rows());
    if (!(xyz[1] > 0)) {
      result.setZero();
      return;
    }
    Eigen::VectorXd found;
    if (solve(xyz, found)) {
      result = found;
      return;
    }
    // Beyond what light can be: the nearest such colour on the way to the grey of its luminance.
    const Eigen::Vector3d grey = m_weights.colwise().sum().transpose() * (xyz[1] / m_weights.col(1).sum());
    result.setConstant(xyz[1] / m_weights.col(1).sum());
    double low = 0;
    double high = 1;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = (low + high) / 2;
      if (solve(grey + middle * (xyz - grey), found)) {
        low = middle;
        result = found;
      } else {
        high = middle;
      }
    }
  }

  UpliftWeights m_weights;
  Eigen::MatrixXd m_inverse;                          ///< of the Hessian
  Eigen::Matrix<double, Eigen::Dynamic, 3> m_smooth;  ///< the answer without bounds, by XYZ
};

}  // namespace

std::unique_ptr<Uplift> makeMeng(const DataLibrary& library, const std::optional<UpliftWeights>& weights) {
  const std::vector<double> wavelengths = JakobSolver::wavelengthsNm();
  const UpliftWeights used = upliftWeightsOr(weights, library, wavelengths);
  return std::make_unique<Meng>(wavelengths, used, upliftXyzFromRgb(library, used));
}

}  // namespace metamer::spectral
