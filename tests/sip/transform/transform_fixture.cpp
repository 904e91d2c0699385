// SPDX-License-Identifier: Apache-2.0
#include "sip/transform/transform_fixture.h"

#include <Eigen/LU>
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

}  // namespace metamer::sip
