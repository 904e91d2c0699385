// SPDX-License-Identifier: Apache-2.0
#include "map/adini_element.h"

namespace metamer::sip {

namespace {

/// Power coefficients of the cubic with values a, b and derivatives da, db at 0 and 1.
std::array<Eigen::Vector3d, 4> hermite(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& da,
                                       const Eigen::Vector3d& db) {
  return {a, da, 3.0 * (b - a) - 2.0 * da - db, 2.0 * (a - b) + da + db};
}

}  // namespace

Adini adiniElement(const std::array<AdiniCorner, 4>& corners, double side) {
  const auto alongU = [&](std::size_t from, std::size_t to) {
    return hermite(corners[from].value, corners[to].value, side * corners[from].alongU, side * corners[to].alongU);
  };
  const auto alongV = [&](std::size_t from, std::size_t to) {
    return hermite(corners[from].value, corners[to].value, side * corners[from].alongV, side * corners[to].alongV);
  };
  const auto bottom = alongU(0, 1);
  const auto top = alongU(2, 3);
  const auto left = alongV(0, 2);
  const auto right = alongV(1, 3);
  const Eigen::Vector3d twist = corners[3].value - corners[2].value - corners[1].value + bottom[0];
  Adini patch{bottom[0],          bottom[1],          bottom[2], bottom[3],          left[1], {},
              top[2] - bottom[2], top[3] - bottom[3], left[2],   right[2] - left[2], left[3], right[3] - left[3]};
  patch[5] = twist - patch[6] - patch[7] - patch[9] - patch[11];
  return patch;
}

}  // namespace metamer::sip
