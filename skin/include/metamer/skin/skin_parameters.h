// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace metamer::skin {

/// What a point of skin is made of (section 3.3, table 3.2).
struct SkinParameters {
  double melanin = 0.03;           ///< Vm, volume fraction of melanosomes in the epidermis, 0 ... 1
  double blood = 0.025;            ///< Vb, volume fraction of blood in the dermis, 0 ... 1
  double thicknessUm = 93;         ///< t of the epidermis in micrometres, 10 ... 350
  double eumelanin = 0.25;         ///< phi_m, eumelanin's share of the melanin, 0 ... 1; the rest is pheomelanin
  double deoxyhaemoglobin = 0.43;  ///< phi_h, haemoglobin without oxygen as a share, 0 ... 1 (1 - saturation)
};

inline constexpr double kThinnestEpidermisUm = 10;
/// As the text says and the authors' program does; table 3.2 prints 250.
inline constexpr double kThickestEpidermisUm = 350;

/// @throws spectral::InputError where a parameter is outside its range or no number
void requireSkin(const SkinParameters& skin);

/// The nearest skin with every parameter in its range; what is no number becomes the default.
SkinParameters withinRanges(const SkinParameters& skin);

/// The parameters as they act on colour nearly linearly (section 3.5): cube root of melanin, fourth root of blood,
/// thickness in micrometres, and the two shares.
using SkinCoordinates = Eigen::Matrix<double, 5, 1>;
SkinCoordinates coordinatesOf(const SkinParameters& skin);
/// The other way; coordinates outside the ranges are cut to them.
SkinParameters skinOf(const SkinCoordinates& coordinates);

/// The ranges of table 3.2, as corrected, as coordinates: melanin and blood from 0.001 on, where it is not said that
/// they begin at 0.
SkinCoordinates lowestCoordinates();
SkinCoordinates highestCoordinates();

}  // namespace metamer::skin
