// SPDX-License-Identifier: Apache-2.0
#include "sip/transform/transform_fixture.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <random>

namespace metamer::sip {

using Eigen::Matrix3d;
using Eigen::Vector3d;

std::vector<Vector3d> colours(int count, unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&random] { return unitRandom(random); };
  std::vector<Vector3d> made;
  for (int i = 0; i < count; ++i) {
    Vector3d colour{uniform(), uniform(), uniform()};  // in braces: one after another
    if (i % 3 == 1) {
      colour[i % 9 / 3] = 0.0;
    } else if (i % 3 == 2) {
      colour = 2.0 * colour - Vector3d::Ones();
    }
    made.push_back(colour);
  }
  return made;
}

std::string pairName(const std::pair<std::string, std::string>& pair) {
  return pair.first + " -> " + pair.second;
}

Vector3d inputRgb(const TransformSpec& spec, const SpectralTransform& transform,
                  const spectral::DomainSamples& reflectance) {
  const PreparedPipeline input = prepare(spec.input, spec.training, spec.standardObserver);
  const Vector3d response = input.curves.transpose() * reflectance.cwiseProduct(input.light);
  return transform.responseFromRgb().inverse() * response.cwiseQuotient(input.white);
}

Vector3d outputRgb(const TransformSpec& spec, const spectral::DomainSamples& reflectance) {
  const PreparedPipeline input = prepare(spec.input, spec.training, spec.standardObserver);
  const PreparedPipeline output = prepare(spec.output, spec.training, spec.standardObserver);
  const Matrix3d cones = spectral::lmsFromXyz(spec.cat);
  const Vector3d white = cones * spec.space.whiteXyz();
  const Vector3d gain = spec.adaptation * white.cwiseQuotient(cones * output.whiteXyz()) +
                        (1.0 - spec.adaptation) * white.cwiseQuotient(cones * input.whiteXyz());
  const Vector3d response = output.curves.transpose() * reflectance.cwiseProduct(output.light);
  const Vector3d xyz = cones.inverse() * (gain.asDiagonal() * (cones * (output.xyzFromResponse * response)));
  return spec.space.rgbFromXyz() * xyz;
}

spectral::Spectrum laser(double wavelengthNm) {
  return spectral::Spectrum("laser", spectral::SpectralQuantity::SpectralPowerDistribution,
                            {wavelengthNm - 1.0, wavelengthNm, wavelengthNm + 1.0}, {0.0, 1.0, 0.0});
}

RelativeColours::RelativeColours(const SpectralTransform& transform)
    : m_transform(transform),
      m_relativeFromRgb(transform.whiteXyz().cwiseInverse().asDiagonal() * transform.space().xyzFromRgb()),
      m_rgbFromRelative(m_relativeFromRgb.inverse()) {}

Vector3d RelativeColours::apply(const Vector3d& relative) const {
  return m_relativeFromRgb * m_transform.apply(Vector3d(m_rgbFromRelative * relative));
}

Matrix3d RelativeColours::derivative(const Vector3d& relative) const {
  return m_relativeFromRgb * m_transform.linearise(m_rgbFromRelative * relative).matrix * m_rgbFromRelative;
}

double RelativeColours::steepness(const Vector3d& relative) const {
  const Matrix3d slope = derivative(relative);
  Eigen::SelfAdjointEigenSolver<Matrix3d> squares;
  squares.computeDirect(slope.transpose() * slope, Eigen::EigenvaluesOnly);
  return std::sqrt(squares.eigenvalues()[2]);
}

}  // namespace metamer::sip
