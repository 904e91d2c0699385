// SPDX-License-Identifier: Apache-2.0
#include "metamer/skin/skin_parameters.h"

#include <algorithm>
#include <cmath>

#include "metamer/spectral/argument_checks.h"

namespace metamer::skin {
namespace {

double cut(double value, double low, double high, double instead) {
  return std::isnan(value) ? instead : std::clamp(value, low, high);
}

}  // namespace

void requireSkin(const SkinParameters& skin) {
  spectral::requireWithin("melanin", skin.melanin, 0, 1);
  spectral::requireWithin("blood", skin.blood, 0, 1);
  spectral::requireWithin("thickness", skin.thicknessUm, kThinnestEpidermisUm, kThickestEpidermisUm);
  spectral::requireWithin("eumelanin", skin.eumelanin, 0, 1);
  spectral::requireWithin("deoxyhaemoglobin", skin.deoxyhaemoglobin, 0, 1);
}

SkinParameters withinRanges(const SkinParameters& skin) {
  const SkinParameters usual;
  return {cut(skin.melanin, 0, 1, usual.melanin), cut(skin.blood, 0, 1, usual.blood),
          cut(skin.thicknessUm, kThinnestEpidermisUm, kThickestEpidermisUm, usual.thicknessUm),
          cut(skin.eumelanin, 0, 1, usual.eumelanin), cut(skin.deoxyhaemoglobin, 0, 1, usual.deoxyhaemoglobin)};
}

SkinCoordinates coordinatesOf(const SkinParameters& skin) {
  return {std::cbrt(skin.melanin), std::sqrt(std::sqrt(skin.blood)), skin.thicknessUm, skin.eumelanin,
          skin.deoxyhaemoglobin};
}

SkinParameters skinOf(const SkinCoordinates& coordinates) {
  const double melanin = std::max(coordinates[0], 0.0);
  const double blood = std::max(coordinates[1], 0.0);
  return withinRanges(
      {melanin * melanin * melanin, blood * blood * blood * blood, coordinates[2], coordinates[3], coordinates[4]});
}

SkinCoordinates lowestCoordinates() {
  return coordinatesOf({0.001, 0.001, kThinnestEpidermisUm, 0, 0});
}

SkinCoordinates highestCoordinates() {
  return coordinatesOf({1, 1, kThickestEpidermisUm, 1, 1});
}

}  // namespace metamer::skin
