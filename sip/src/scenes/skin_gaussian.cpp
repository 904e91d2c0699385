// SPDX-License-Identifier: Apache-2.0
#include "scenes/skin_gaussian.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "response/chromaticity.h"

namespace metamer::sip {

namespace {

using Eigen::Index;
using Eigen::Vector2d;

/// Variances added to responses and places, so that a light that shows fewer than three colours leaves a spectrum: far
/// below what skins vary by under any lamp that shows three.
constexpr double kLeastResponse = 1e-8;
constexpr double kLeastPlace = 1e-6;
/// How near to white, beside the skins' mean, the share is held down: at a quarter of the way it is whole to a third.
constexpr double kWhiteSharpness = 16;

Eigen::MatrixXd ofMeanOne(const Eigen::Matrix3Xd& weights, const Eigen::MatrixXd& reflectances) {
  const Eigen::RowVectorXd means = (weights * reflectances).colwise().mean();
  std::vector<Index> shown;
  for (Index k = 0; k < means.size(); ++k) {
    if (means[k] >= kDarkestMean) {
      shown.push_back(k);
    }
  }
  return reflectances(Eigen::all, shown).array().rowwise() / means(shown).array();
}

}  // namespace

SkinGaussian::SkinGaussian(const Eigen::Matrix<double, 2, 3>& differences, const Eigen::Matrix3Xd& weights,
                           const Eigen::MatrixXd& reflectances, double share, double fade)
    : m_share(share), m_fade(fade) {
  const Eigen::MatrixXd skins = ofMeanOne(weights, reflectances);
  const double each = 1.0 / static_cast<double>(skins.cols());
  const Eigen::Matrix3Xd responses = weights * skins;

  // The best linear guess of a spectrum from its response. Responses of mean one hold the constant, so that this is the
  // Gaussian's conditional mean over chromaticity.
  const Eigen::MatrixX3d crossed = each * skins * responses.transpose();
  const Eigen::Matrix3d own = each * responses * responses.transpose() + kLeastResponse * Eigen::Matrix3d::Identity();
  const Eigen::MatrixX3d spectra = crossed * own.inverse();
  m_spectra.resize(spectra.rows() + 3, 3);
  m_spectra << spectra, weights * spectra;

  Eigen::Matrix3d placeFromResponse;
  placeFromResponse << differences, Eigen::RowVector3d::Constant(1.0 / 3.0);
  m_responseFromPlace = placeFromResponse.inverse();

  const Eigen::Matrix2Xd places = differences * responses;
  m_centre = places.rowwise().mean();
  const Eigen::Matrix2Xd centred = places.colwise() - m_centre;
  m_precision = (each * centred * centred.transpose() + kLeastPlace * Eigen::Matrix2d::Identity()).inverse();
}

SkinGaussian::Share SkinGaussian::share(const Vector2d& place) const {
  const Vector2d away = place - m_centre;
  const Vector2d pull = m_precision * away;
  const double fades = 1.0 / (m_fade * m_fade);
  const double distance = std::sqrt(std::max(away.dot(pull), 0.0) * fades);
  const double skin = m_share * std::exp(-0.5 * distance * distance * distance);
  const double steepness = 1.5 * distance * fades;
  const double sharpness = kWhiteSharpness / std::max(m_centre.squaredNorm(), kLeastPlace);
  const double atWhite = std::exp(-sharpness * place.squaredNorm());
  return {skin * (1.0 - atWhite), skin * (2.0 * sharpness * atWhite * place - (1.0 - atWhite) * steepness * pull)};
}

}  // namespace metamer::sip
