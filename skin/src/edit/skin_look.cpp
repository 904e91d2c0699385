// SPDX-License-Identifier: Apache-2.0
#include "metamer/skin/skin_look.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "metamer/spectral/argument_checks.h"

namespace metamer::skin {
namespace {

using Eigen::Array2d;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr int kDraws = 1000;
/// Skins are no brighter or darker than that, whatever a quadratic says far from them.
constexpr double kDarkest = 0.05;
constexpr double kBrightest = 0.7;
/// Added to the variance of chromaticities, for views that show fewer than three colours.
constexpr double kLeastVariance = 1e-8;
/// Where a reach is set: how near to white, beside skins' mean, an edit is held down, and over what part of the range
/// it ends.
constexpr double kWhiteSharpness = 16;
constexpr double kEdge = 0.1;

Array2d chromaticityOf(const Vector3d& rgb, double mean) {
  return {(rgb[0] - rgb[1]) / mean, (rgb[2] - rgb[1]) / mean};
}

void requireRanges(const SkinLookSettings& settings) {
  constexpr double kMost = 1000;
  spectral::requireWithin("melanin", settings.melanin, 0, kMost);
  spectral::requireWithin("blood", settings.blood, 0, kMost);
  spectral::requireWithin("tan", settings.tan, 0, 4);
  spectral::requireWithin("flush", settings.flush, -0.9, 4);
  spectral::requireWithin("oxygenation", settings.oxygenation, -1, 1);
  spectral::requireWithin("strength", settings.strength, 0, 1);
  spectral::requireWithin("reach", settings.reach, std::numeric_limits<double>::min(),
                          std::numeric_limits<double>::infinity());
}

}  // namespace

bool isNeutral(const SkinLookSettings& settings) {
  return settings.strength == 0 || (settings.melanin == 1 && settings.blood == 1 && settings.tan == 0 &&
                                    settings.flush == 0 && settings.oxygenation == 0);
}

SkinLook::SkinLook(const SkinEstimator& estimator, const SkinLookSettings& settings)
    : m_estimator(estimator),
      m_settings(settings),
      m_range(estimator.chromaticities()),
      m_isIdentity(isNeutral(settings)) {
  requireRanges(settings);
  if (!m_isIdentity) {
    learnBrightness();
  }
}

SkinLook::Quadratic SkinLook::terms(const Array2d& at) {
  Quadratic terms;
  terms << 1, at[0], at[1], at[0] * at[0], at[0] * at[1], at[1] * at[1];
  return terms;
}

void SkinLook::learnBrightness() {
  Eigen::Matrix<double, Eigen::Dynamic, 6> rows(kDraws, 6);
  Eigen::VectorXd brightness(kDraws);
  Eigen::Matrix2Xd places(2, kDraws);
  Eigen::Index used = 0;
  for (const SkinParameters& skin : sampleSkins(m_estimator.colours().prior(), kDraws, 1)) {
    SkinPixel pixel;
    pixel.skin = {static_cast<float>(skin.melanin), static_cast<float>(skin.blood),
                  static_cast<float>(skin.thicknessUm), static_cast<float>(skin.eumelanin),
                  static_cast<float>(skin.deoxyhaemoglobin)};
    const Vector3d rgb = m_estimator.colour(pixel).cast<double>();
    const double mean = rgb.mean();
    // Cameras' matrices may leave a dark skin without brightness.
    if (mean > 0) {
      const Array2d place = chromaticityOf(rgb, mean);
      rows.row(used) = terms(place).transpose();
      brightness[used] = std::log(mean);
      places.col(used) = place.matrix();
      ++used;
    }
  }
  // The shortest coefficients where a view sees no colour along an axis.
  m_logBrightness = rows.topRows(used).completeOrthogonalDecomposition().solve(brightness.head(used));
  m_centre = places.leftCols(used).rowwise().mean();
  const Eigen::Matrix2Xd centred = places.leftCols(used).colwise() - m_centre;
  const Eigen::Matrix2d covariance = centred * centred.transpose() / std::max<double>(1, static_cast<double>(used));
  m_precision = (covariance + kLeastVariance * Eigen::Matrix2d::Identity()).inverse();
}

double SkinLook::shareAt(const Array2d& at) const {
  if (std::isinf(m_settings.reach)) {
    return 1;
  }
  const Eigen::Vector2d away = at.matrix() - m_centre;
  const double distance = away.dot(m_precision * away) / (m_settings.reach * m_settings.reach);
  const double white =
      std::exp(-kWhiteSharpness * at.matrix().squaredNorm() / std::max(m_centre.squaredNorm(), kLeastVariance));
  // Nothing at the ends of the range, which stand for all that is outside.
  const Array2d width = kEdge * (m_range.high - m_range.low);
  const double inside = ((at - m_range.low) / width).min((m_range.high - at) / width).min(1).max(0).minCoeff();
  return std::exp(-0.5 * distance * distance) * (1 - white) * inside * inside * (3 - 2 * inside);
}

SkinPixel SkinLook::edited(SkinPixel pixel) const {
  const std::span<SkinPixel> one(&pixel, 1);
  const std::array<float, 5> before = pixel.skin;
  multiplySkin(one, SkinQuantity::Melanin, m_settings.melanin);
  multiplySkin(one, SkinQuantity::Blood, m_settings.blood);
  tanSkin(one, m_settings.tan);
  flushSkin(one, m_settings.flush);
  oxygenateSkin(one, m_settings.oxygenation);
  const auto strength = static_cast<float>(m_settings.strength);
  if (strength < 1) {
    for (std::size_t k = 0; k < before.size(); ++k) {
      pixel.skin[k] = before[k] + strength * (pixel.skin[k] - before[k]);
    }
  }
  return pixel;
}

Vector3f SkinLook::change(const Array2d& chromaticity) const {
  if (m_isIdentity) {
    return Vector3f::Zero();
  }
  const Array2d at = chromaticity.max(m_range.low).min(m_range.high);
  const double mean = std::clamp(std::exp(m_logBrightness.dot(terms(at))), kDarkest, kBrightest);
  const double green = 1 - (at[0] + at[1]) / 3;
  SkinPixel skin = m_estimator.estimate((mean * Vector3d(at[0] + green, green, at[1] + green)).cast<float>());
  skin.residual = {};
  return static_cast<float>(shareAt(at) / mean) * (m_estimator.colour(edited(skin)) - m_estimator.colour(skin));
}

Vector3f SkinLook::apply(const Vector3f& rgb) const {
  const Vector3d colour = rgb.cast<double>();
  const double mean = colour.mean();
  // Written so that NaN stays.
  if (m_isIdentity || !(mean > 0) || !rgb.allFinite()) {
    return rgb;
  }
  const Vector3f result = (colour + mean * change(chromaticityOf(colour, mean)).cast<double>()).cast<float>();
  return result.allFinite() ? result : rgb;
}

}  // namespace metamer::skin
