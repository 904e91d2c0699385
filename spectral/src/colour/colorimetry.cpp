// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/colorimetry.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/spectral_integral.h"
#include "metamer/spectral/text.h"

namespace metamer::spectral {
namespace {

constexpr double kPi = std::numbers::pi;

double degrees(double radians) {
  return radians * 180.0 / kPi;
}
double radians(double degrees) {
  return degrees * kPi / 180.0;
}

/// CIE 015:2018, equations 8.4 and 8.5, in the exact fractions of its note.
double lightnessResponse(double ratio) {
  constexpr double kCut = (24.0 / 116.0) * (24.0 / 116.0) * (24.0 / 116.0);
  return ratio > kCut ? std::cbrt(ratio) : 841.0 / 108.0 * ratio + 16.0 / 116.0;
}

/// Hue angle in 0 ... 360 degrees, 0 for neutrals.
double hueDegrees(double a, double b) {
  if (a == 0 && b == 0) {
    return 0;
  }
  const double angle = degrees(std::atan2(b, a));
  return angle < 0 ? angle + 360.0 : angle;
}

double pow7(double x) {
  const double x3 = x * x * x;
  return x3 * x3 * x;
}

/// sqrt(C^7 / (C^7 + 25^7)), the blue and chroma weighting that CIEDE2000 uses twice.
double chromaWeight(double chroma) {
  return std::sqrt(pow7(chroma) / (pow7(chroma) + pow7(25.0)));
}

/// Of the angles in CIEDE2000's weight of hues, degrees.
constexpr double kCos30 = 0.86602540378443864676;
constexpr double kSin30 = 0.5;
constexpr double kCos6 = 0.99452189536827333692;
constexpr double kSin6 = 0.10452846326765347140;
constexpr double kCos63 = 0.45399049973954679156;
constexpr double kSin63 = 0.89100652418836786236;

struct Terms2000 {
  double lightness;
  double chroma;
  double hue;
  double rotation;           ///< the cross term of chroma and hue, -2 ... 2
  Eigen::Vector2d midpoint;  ///< a' and b, twice those between the two colours
};

/// Of the two ways round from one hue to another, whether the shorter one rises. @param cross  of the two directions.
/// Exactly opposite hues are 180 degrees apart by their angles in 0 ... 360, whatever a rounding error says: the
/// formula is discontinuous there.
bool rises(const Eigen::Vector2d& from, double cross) {
  return cross > 0.0 || (cross == 0.0 && (from[1] > 0.0 || (from[1] == 0.0 && from[0] > 0.0)));
}

/// Direction of the mean hue, in the middle of the shorter way round. @param rising  as rises() says
Eigen::Vector2d meanDirection(const Eigen::Vector2d& unit1, const Eigen::Vector2d& unit2, bool rising) {
  if (unit1.dot(unit2) >= 0.0) {
    return (unit1 + unit2).normalized();
  }
  const Eigen::Vector2d across = (unit2 - unit1).normalized();
  return rising ? Eigen::Vector2d(across[1], -across[0]) : Eigen::Vector2d(-across[1], across[0]);
}

/// The parts of CIEDE2000 from lab1 to lab2, each over its own tolerance. Hues are directions, not angles: sums and
/// multiples of angles are then products, and one arc tangent is left.
Terms2000 terms2000(const Eigen::Vector3d& lab1, const Eigen::Vector3d& lab2) {
  // Sharma, Wu and Dalal 2005, equations 2 to 22.
  const double meanChroma = (lab1.tail<2>().norm() + lab2.tail<2>().norm()) / 2.0;
  const double stretch = 1.0 + 0.5 * (1.0 - chromaWeight(meanChroma));
  const Eigen::Vector2d ab1(stretch * lab1[1], lab1[2]);
  const Eigen::Vector2d ab2(stretch * lab2[1], lab2[2]);
  const double c1 = ab1.norm();
  const double c2 = ab2.norm();

  // Neutrals have no hue of their own: no difference, and the other's for a mean.
  double hueDifference = 0.0;
  Eigen::Vector2d hue(1.0, 0.0);
  if (c1 > 0.0 && c2 > 0.0) {
    const double cross = ab1[0] * ab2[1] - ab1[1] * ab2[0];
    const double dot = ab1.dot(ab2);
    const bool rising = rises(ab1, cross);
    // 2 sqrt(c1 c2) sin(half the angle between), each way where it keeps its digits.
    hueDifference = dot > 0.0 ? 2.0 * cross / std::sqrt(2.0 * (c1 * c2 + dot))
                              : (rising ? 1.0 : -1.0) * std::sqrt(2.0 * (c1 * c2 - dot));
    hue = meanDirection(ab1 / c1, ab2 / c2, rising);
  } else if (c1 + c2 > 0.0) {
    hue = (ab1 + ab2) / (c1 + c2);
  }
  const auto [cos1, sin1] = std::pair(hue[0], hue[1]);
  const auto [cos2, sin2] = std::pair(cos1 * cos1 - sin1 * sin1, 2.0 * sin1 * cos1);
  const auto [cos3, sin3] = std::pair(cos1 * cos2 - sin1 * sin2, sin1 * cos2 + cos1 * sin2);
  const auto [cos4, sin4] = std::pair(cos2 * cos2 - sin2 * sin2, 2.0 * sin2 * cos2);
  const double t = 1.0 - 0.17 * (kCos30 * cos1 + kSin30 * sin1) + 0.24 * cos2 + 0.32 * (kCos6 * cos3 - kSin6 * sin3) -
                   0.20 * (kCos63 * cos4 + kSin63 * sin4);

  const double meanLightness = (lab1[0] + lab2[0]) / 2.0;
  const double meanPrimeChroma = (c1 + c2) / 2.0;
  const double blueness = (hueDegrees(hue[0], hue[1]) - 275.0) / 25.0;
  const double rotation = 30.0 * std::exp(-blueness * blueness);
  const double lightnessOffset = (meanLightness - 50.0) * (meanLightness - 50.0);
  const double sL = 1.0 + 0.015 * lightnessOffset / std::sqrt(20.0 + lightnessOffset);
  const double sC = 1.0 + 0.045 * meanPrimeChroma;
  const double sH = 1.0 + 0.015 * meanPrimeChroma * t;
  const double rT = -std::sin(radians(2.0 * rotation)) * 2.0 * chromaWeight(meanPrimeChroma);

  return {(lab2[0] - lab1[0]) / sL, (c2 - c1) / sC, hueDifference / sH, rT, ab1 + ab2};
}

}  // namespace

Eigen::Vector3d response(const Spectrum& power, const Observer& observer) {
  const SeenLight seen = seenLight(power, {}, observer);
  return seen.curves.transpose() * seen.light;
}

Eigen::Vector3d tristimulus(const Spectrum& reflectance, const Spectrum& light, const Observer& observer) {
  const auto [power, curves] = seenLight(light, {}, observer);
  const double white = curves.col(1).dot(power);
  // The comparison also refuses NaN.
  if (!(white > 0)) {
    throw InputError(light.name(), "light", "", "gives observer '" + observer.name + "' no response in 380 to 780 nm");
  }
  return curves.transpose() * power.cwiseProduct(reflectance.onDomain()) / white;
}

Eigen::Vector2d chromaticity(const Eigen::Vector3d& xyz) {
  const double sum = xyz.sum();
  if (!(sum > 0)) {
    return Eigen::Vector2d::Zero();
  }
  return xyz.head<2>() / sum;
}

Eigen::Vector3d xyzFromChromaticity(const Eigen::Vector2d& xy, double Y) {
  if (xy.y() == 0.0 || !xy.allFinite()) {
    throw InputError("", "chromaticity", numberText(xy.x()) + " " + numberText(xy.y()), "must be finite, and y not 0");
  }
  return {xy.x() / xy.y() * Y, Y, (1.0 - xy.x() - xy.y()) / xy.y() * Y};
}

Eigen::Vector2d chromaticityUv(const Eigen::Vector3d& xyz) {
  const double sum = xyz.x() + 15.0 * xyz.y() + 3.0 * xyz.z();
  if (!(sum > 0)) {
    return Eigen::Vector2d::Zero();
  }
  return {4.0 * xyz.x() / sum, 9.0 * xyz.y() / sum};
}

Eigen::Vector3d lab(const Eigen::Vector3d& xyz, const Eigen::Vector3d& white) {
  const Eigen::Vector3d ratio = xyz.cwiseQuotient(white);
  const double fx = lightnessResponse(ratio.x());
  const double fy = lightnessResponse(ratio.y());
  const double fz = lightnessResponse(ratio.z());
  return {116.0 * fy - 16.0, 500.0 * (fx - fy), 200.0 * (fy - fz)};
}

double deltaE2000(const Eigen::Vector3d& lab1, const Eigen::Vector3d& lab2) {
  const auto [l, c, h, rotation, midpoint] = terms2000(lab1, lab2);
  // The rotation term can outweigh the squares by a rounding error between equal colours.
  const double square = l * l + c * c + h * h + rotation * c * h;
  // Written so that NaN stays NaN: no difference must not be what is no number.
  return square < 0.0 ? 0.0 : std::sqrt(square);
}

Eigen::Vector3d difference2000(const Eigen::Vector3d& lab1, const Eigen::Vector3d& lab2) {
  const Terms2000 terms = terms2000(lab1, lab2);
  // The square completed: c^2 + h^2 + r c h = (c + r h / 2)^2 + (1 - r^2 / 4) h^2, where |r| < 2.
  const double along = terms.chroma + 0.5 * terms.rotation * terms.hue;
  const double across = std::sqrt(1.0 - 0.25 * terms.rotation * terms.rotation) * terms.hue;
  // Turned from chroma and hue to a and b by the hue of the midpoint: of a grey and a colour that is the colour's,
  // where the formula's own mean hue hangs on the grey's last bits.
  const double length = terms.midpoint.norm();
  const Eigen::Vector2d hue = length > 0.0 ? Eigen::Vector2d(terms.midpoint / length) : Eigen::Vector2d(1.0, 0.0);
  return {terms.lightness, hue[0] * along - hue[1] * across, hue[1] * along + hue[0] * across};
}

}  // namespace metamer::spectral
