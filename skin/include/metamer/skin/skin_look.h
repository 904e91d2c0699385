// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <limits>

#include "metamer/skin/skin_edit.h"
#include "metamer/skin/skin_estimator.h"

namespace metamer::skin {

/// Edits of skin (skin_edit.h), in this order.
struct SkinLookSettings {
  double melanin = 1;      ///< factor, 0 ... 1000
  double blood = 1;        ///< factor, 0 ... 1000
  double tan = 0;          ///< 0 ... 4
  double flush = 0;        ///< -0.9 ... 4
  double oxygenation = 0;  ///< -1 ... 1
  double strength = 1;     ///< 0 ... 1: how far the parameters go there
  /// How far from skins' mean chromaticity colours count as skin, in skins' standard deviations, above 0. Beyond, the
  /// edit fades as exp(-m^4 / (2 reach^4)), and white stays; infinite: every colour is edited, as the nearest skin is.
  double reach = std::numeric_limits<double>::infinity();
};

/// Whether settings change nothing.
bool isNeutral(const SkinLookSettings& settings);

/// Edits as a function of colour for pictures of light, not albedos: what lies in shade is not darker skin. Each colour
/// is taken for a skin of its chromaticity as bright as skins of that chromaticity are in the mean, times a gain. So
/// the look is homogeneous of degree one: the same at any exposure. What the skin lacks of the colour is kept.
/// Immutable, safe between threads.
class SkinLook {
 public:
  /// @throws spectral::InputError outside the settings' ranges
  SkinLook(const SkinEstimator& estimator, const SkinLookSettings& settings);

  /// Nothing would change, to the last bit.
  bool isIdentity() const { return m_isIdentity; }

  /// A colour's result. A colour without brightness (its mean not above 0), or that is no number, stays as it is.
  Eigen::Vector3f apply(const Eigen::Vector3f& rgb) const;

  /// What is added to a colour of mean one, by its chromaticity, (R - G) and (B - G) over the mean. Outside the
  /// estimator's chromaticities it is that of the nearest one.
  Eigen::Vector3f change(const Eigen::Array2d& chromaticity) const;
  /// Those chromaticities.
  const SkinChromaticities& chromaticities() const { return m_range; }

 private:
  using Quadratic = Eigen::Matrix<double, 6, 1>;
  static Quadratic terms(const Eigen::Array2d& at);
  void learnBrightness();
  SkinPixel edited(SkinPixel pixel) const;
  double shareAt(const Eigen::Array2d& at) const;

  SkinEstimator m_estimator;
  SkinLookSettings m_settings;
  SkinChromaticities m_range;
  bool m_isIdentity;
  Quadratic m_logBrightness;
  Eigen::Vector2d m_centre;
  Eigen::Matrix2d m_precision;
};

}  // namespace metamer::skin
