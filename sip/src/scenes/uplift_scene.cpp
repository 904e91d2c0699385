// SPDX-License-Identifier: Apache-2.0
#include "scenes/uplift_scene.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include "metamer/sip/band_weights.h"
#include "metamer/spectral/input_error.h"

namespace metamer::sip {
namespace {

/// Of a response's size, for slopes: the uplifts that are solved are so to 1e-6 or better.
constexpr double kStep = 1e-3;

/// From colours of daylight to responses of white (1, 1, 1): I + K D, where D takes differences of channels, which
/// white has none of.
Eigen::Matrix3d daylightFromResponses(const Eigen::Matrix3Xd& responses, const std::vector<Eigen::Vector3d>& colours) {
  Eigen::Matrix<double, 2, 3> differences;
  differences << 1.0, -1.0, 0.0, 0.0, 1.0, -1.0;
  // Normal equations of what differs by two differences.
  Eigen::Matrix2d square = Eigen::Matrix2d::Zero();
  Eigen::Matrix<double, 3, 2> right = Eigen::Matrix<double, 3, 2>::Zero();
  for (Eigen::Index k = 0; k < responses.cols(); ++k) {
    // Each surface counts alike, however dark.
    const Eigen::Vector3d response = responses.col(k);
    const double size = std::max(response.cwiseAbs().maxCoeff(), 1e-9);
    const Eigen::Vector2d known = differences * response / size;
    square += known * known.transpose();
    right += (colours[static_cast<std::size_t>(k)] - response) / size * known.transpose();
  }
  return Eigen::Matrix3d::Identity() + right * square.inverse() * differences;
}

/// Band centres from a table that is linear between its wavelengths and held beyond them.
Eigen::MatrixXd interpolation(const std::vector<double>& wavelengthsNm, int bandCount) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(bandCount, static_cast<Eigen::Index>(wavelengthsNm.size()));
  for (int band = 0; band < bandCount; ++band) {
    const double nm = std::clamp(bandCentreNm(band, bandCount), wavelengthsNm.front(), wavelengthsNm.back());
    const auto above = std::clamp(std::upper_bound(wavelengthsNm.begin(), wavelengthsNm.end(), nm),
                                  wavelengthsNm.begin() + 1, wavelengthsNm.end() - 1);
    const double part = (nm - *(above - 1)) / (*above - *(above - 1));
    const auto at = above - wavelengthsNm.begin();
    matrix(band, at - 1) = 1.0 - part;
    matrix(band, at) = part;
  }
  return matrix;
}

}  // namespace

UpliftScene::UpliftScene(const SoftBoundSolver& solver, std::shared_ptr<const spectral::Uplift> uplift,
                         const Eigen::MatrixXd& surfaces, const std::vector<Eigen::Vector3d>& colours)
    : m_uplift(std::move(uplift)) {
  if (m_uplift == nullptr || surfaces.cols() < 3 || static_cast<Eigen::Index>(colours.size()) != surfaces.cols()) {
    throw spectral::InputError("recipe", "scene.uplift", std::to_string(colours.size()),
                               "a scene of an uplift needs surfaces, three or more, and a colour for each");
  }
  m_rgbFromResponse = daylightFromResponses(solver.weights() * surfaces, colours);
  const Eigen::MatrixXd bands = interpolation(m_uplift->wavelengthsNm(), solver.bandCount());
  m_deviationFromSpectrum = bands - solver.unclamped() * (solver.weights() * bands);
  m_ofWhite = BandVector::Zero(solver.bandCount());
  m_ofWhite = deviation(Eigen::Vector3d::Ones());
}

Eigen::MatrixXd UpliftScene::deviations(const Eigen::Matrix3Xd& responses) const {
  const Eigen::Matrix3Xd rgb = m_rgbFromResponse * responses;
  Eigen::RowVectorXd sizes = Eigen::RowVectorXd::Zero(rgb.cols());
  Eigen::Matrix3Xd asked = Eigen::Matrix3Xd::Zero(3, rgb.cols());
  for (Eigen::Index k = 0; k < rgb.cols(); ++k) {
    const double largest = rgb.col(k).maxCoeff();
    if (rgb.col(k).allFinite() && largest > 0.0) {
      sizes[k] = largest / kBrightness;
      asked.col(k) = (rgb.col(k) / sizes[k]).cwiseMax(0.0);
    }
  }
  Eigen::MatrixXd spectra(static_cast<Eigen::Index>(m_uplift->wavelengthsNm().size()), rgb.cols());
  m_uplift->spectra(std::span(asked.data(), static_cast<std::size_t>(asked.size())),
                    std::span(spectra.data(), static_cast<std::size_t>(spectra.size())));
  Eigen::MatrixXd result = (m_deviationFromSpectrum * spectra).array().rowwise() * sizes.array();
  for (Eigen::Index k = 0; k < rgb.cols(); ++k) {
    if (sizes[k] == 0.0) {
      result.col(k).setZero();
    } else {
      result.col(k) -= std::max(rgb.col(k).minCoeff(), 0.0) * m_ofWhite;
    }
  }
  return result;
}

UpliftScene::Local UpliftScene::local(const Eigen::Vector3d& response) const {
  const double step = kStep * response.cwiseAbs().maxCoeff();
  Local local{deviation(response), BandTriple::Zero(m_deviationFromSpectrum.rows(), 3)};
  if (!(step > 0.0) || !std::isfinite(step)) {
    return local;
  }
  Eigen::Matrix<double, 3, 6> moved = response.replicate<1, 6>();
  moved.leftCols<3>().diagonal().array() += step;
  moved.rightCols<3>().diagonal().array() -= step;
  const Eigen::MatrixXd values = deviations(moved);
  local.slope = (values.leftCols<3>() - values.rightCols<3>()) / (2.0 * step);
  // What scales with exposure has a slope along itself that is itself.
  local.slope += (local.value - local.slope * response) * response.transpose() / response.squaredNorm();
  return local;
}

}  // namespace metamer::sip
