// SPDX-License-Identifier: Apache-2.0
#include "transform/sides.h"

#include <Eigen/LU>

#include "metamer/sip/band_weights.h"
#include "metamer/spectral/input_error.h"

namespace metamer::sip {

using spectral::InputError;

namespace {

/// A channel whose white is this much darker than the brightest one's is dark.
constexpr double kDarkChannel = 1e-12;
/// The same for a cone of the eye that is to adapt.
constexpr double kDarkCone = 1e-9;

}  // namespace

Sides prepareSides(const TransformSpec& spec) {
  if (!(spec.adaptation >= 0.0 && spec.adaptation <= 1.0)) {
    throw InputError("recipe", "adaptation", std::to_string(spec.adaptation), "give a number from 0 to 1");
  }
  Sides sides;
  sides.input = prepare(spec.input, spec.training, spec.standardObserver);
  sides.output = prepare(spec.output, spec.training, spec.standardObserver);
  const PreparedPipeline& input = sides.input;
  const PreparedPipeline& output = sides.output;
  // A channel without any light has no white to be normalised by: low-pressure sodium leaves an eye's blue one dark.
  if (!(input.white.minCoeff() > kDarkChannel * input.white.maxCoeff())) {
    throw InputError(spec.input.illuminant.name(), "input.observer", spec.input.observer.name,
                     "gets nothing from this light in one of its channels; use another observer or another light");
  }
  const double exposure = spec.keepExposure ? output.filterTransmission / input.filterTransmission : 1.0;
  sides.equal = input.light == output.light && input.curves == output.curves &&
                input.xyzFromResponse == output.xyzFromResponse && exposure == 1.0;

  const Eigen::Vector3d white = spec.space.whiteXyz();
  const Eigen::Matrix3d relativeFromXyz = white.cwiseInverse().asDiagonal();
  const Eigen::Matrix3d xyzFromNormalised = input.xyzFromResponse * input.white.asDiagonal();
  sides.responseFromRgb =
      xyzFromNormalised.inverse() * spectral::adaptXyz(spec.cat, white, input.whiteXyz()) * spec.space.xyzFromRgb();
  sides.relativeFromRgb = relativeFromXyz * spec.space.xyzFromRgb();
  sides.relativeFromResponse = sides.relativeFromRgb * sides.responseFromRgb.inverse();

  const Eigen::Matrix3d cones = spectral::lmsFromXyz(spec.cat);
  const Eigen::Array3d whiteCones = (cones * white).array();
  const Eigen::Array3d inputCones = (cones * input.whiteXyz()).array();
  const Eigen::Array3d outputCones = (cones * output.whiteXyz()).array();
  const Eigen::Array3d dark = (outputCones <= kDarkCone).cast<double>();
  if (spec.adaptation > 0.0 && dark.any()) {
    throw InputError(spec.output.illuminant.name(), "adaptation", std::to_string(spec.adaptation),
                     "the eye cannot adapt to this light with " + spectral::nameOf(spec.cat) +
                         " (no response in one cone); use adaptation 0 or vonkries");
  }
  const auto onCones = [&](const Eigen::Array3d& gain) -> Eigen::Matrix3d {
    return cones.inverse() * gain.matrix().asDiagonal() * cones;
  };
  const Eigen::Array3d full = (1.0 - dark) * whiteCones / (outputCones + dark);
  sides.relativeFromOutputResponse = relativeFromXyz * onCones(full) * output.xyzFromResponse;
  sides.unseen = relativeFromXyz * onCones(dark) * white.asDiagonal();
  // The gain in cone space is D W / W_out + (1 - D) W / W_in: this much of full adaptation's.
  const Eigen::Array3d degree = spec.adaptation + (1.0 - spec.adaptation) * outputCones / inputCones;
  sides.rgbFromRelative = exposure * spec.space.rgbFromXyz() * onCones(degree) * white.asDiagonal();
  const Eigen::Array3d gain = (1.0 - spec.adaptation) * whiteCones / inputCones + spec.adaptation * full;
  sides.rgbFromOutputResponse = exposure * spec.space.rgbFromXyz() * onCones(gain) * output.xyzFromResponse;
  return sides;
}

Eigen::Matrix3Xd Sides::inputWeights(int bandCount) const {
  return input.white.cwiseInverse().asDiagonal() * bandWeights(input.light, input.curves, bandCount);
}

Eigen::Matrix3Xd Sides::relativeWeights(int bandCount) const {
  return relativeFromOutputResponse * bandWeights(output.light, output.curves, bandCount);
}

}  // namespace metamer::sip
