// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/colorimetry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

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

struct Terms2000 {
  double lightness;
  double chroma;
  double hue;
  double rotation;           ///< the cross term of chroma and hue, -2 ... 2
  Eigen::Vector2d midpoint;  ///< a' and b, twice those between the two colours
};

/// The parts of CIEDE2000 from lab1 to lab2, each over its own tolerance.
Terms2000 terms2000(const Eigen::Vector3d& lab1, const Eigen::Vector3d& lab2) {
  // Sharma, Wu and Dalal 2005, equations 2 to 22.
  const double meanChroma = (std::hypot(lab1[1], lab1[2]) + std::hypot(lab2[1], lab2[2])) / 2.0;
  const double stretch = 1.0 + 0.5 * (1.0 - chromaWeight(meanChroma));
  const double a1 = stretch * lab1[1];
  const double a2 = stretch * lab2[1];
  const double c1 = std::hypot(a1, lab1[2]);
  const double c2 = std::hypot(a2, lab2[2]);
  const double h1 = hueDegrees(a1, lab1[2]);
  const double h2 = hueDegrees(a2, lab2[2]);

  const bool neutral = c1 * c2 == 0;
  // Exactly opposite hues count as 180 degrees apart whatever way the last bit of the two arc tangents fell: the
  // formula is discontinuous there.
  const bool opposite = a1 * lab2[2] == a2 * lab1[2];
  const bool throughZero = std::abs(h1 - h2) > 180 && !opposite;
  double hueStep = neutral ? 0 : h2 - h1;
  if (throughZero) {
    hueStep += hueStep > 0 ? -360 : 360;
  }
  const double lightnessDifference = lab2[0] - lab1[0];
  const double chromaDifference = c2 - c1;
  const double hueDifference = 2.0 * std::sqrt(c1 * c2) * std::sin(radians(hueStep / 2.0));

  const double meanLightness = (lab1[0] + lab2[0]) / 2.0;
  const double meanPrimeChroma = (c1 + c2) / 2.0;
  double meanHue = h1 + h2;
  if (!neutral) {
    if (throughZero) {
      meanHue += meanHue < 360 ? 360 : -360;
    }
    meanHue /= 2;
  }

  const double t = 1.0 - 0.17 * std::cos(radians(meanHue - 30.0)) + 0.24 * std::cos(radians(2.0 * meanHue)) +
                   0.32 * std::cos(radians(3.0 * meanHue + 6.0)) - 0.20 * std::cos(radians(4.0 * meanHue - 63.0));
  const double blueness = (meanHue - 275.0) / 25.0;
  const double rotation = 30.0 * std::exp(-blueness * blueness);
  const double lightnessOffset = (meanLightness - 50.0) * (meanLightness - 50.0);
  const double sL = 1.0 + 0.015 * lightnessOffset / std::sqrt(20.0 + lightnessOffset);
  const double sC = 1.0 + 0.045 * meanPrimeChroma;
  const double sH = 1.0 + 0.015 * meanPrimeChroma * t;
  const double rT = -std::sin(radians(2.0 * rotation)) * 2.0 * chromaWeight(meanPrimeChroma);

  return {lightnessDifference / sL, chromaDifference / sC, hueDifference / sH, rT, {a1 + a2, lab1[2] + lab2[2]}};
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
  const double hue = radians(hueDegrees(terms.midpoint[0], terms.midpoint[1]));
  return {terms.lightness, std::cos(hue) * along - std::sin(hue) * across,
          std::sin(hue) * along + std::cos(hue) * across};
}

}  // namespace metamer::spectral
