// SPDX-License-Identifier: Apache-2.0
#include "transform/sides.h"

#include <Eigen/LU>
#include <Eigen/SVD>

#include "metamer/sip/band_weights.h"
#include "metamer/spectral/input_error.h"
#include "transform/side_balance.h"

namespace metamer::sip {

using spectral::InputError;

namespace {

/// A channel whose white is this much darker than the brightest one's is dark.
constexpr double kDarkChannel = 1e-12;
/// A cone of a white whose Y is 1 has no light where it is not above this.
constexpr double kDarkCone = 1e-9;
/// Curves, each of length 1, whose least singular value is this much smaller than the largest are collinear: files
/// carry six digits.
constexpr double kCollinear = 1e-5;

std::string notReached(const std::string& part, const std::string& adaptation) {
  return "does not reach this light (no response in one " + part + "); use " +
         (adaptation == "vonkries" ? "another light" : "vonkries");
}

/// Three curves that two would do for, or one, see no colours: no matrix leads from their responses to XYZ.
void refuseCollinear(const Pipeline& pipeline, const char* field) {
  Eigen::MatrixXd curves = pipeline.observer.onDomain();  // dynamic: too large for the stack
  for (Eigen::Index k = 0; k < 3; ++k) {
    curves.col(k).normalize();  // a column of zeros stays
  }
  const Eigen::Vector3d sizes = curves.jacobiSvd().singularValues();
  if (!(sizes[2] > kCollinear * sizes[0])) {
    throw InputError("", field, pipeline.observer.name,
                     "its three channels are collinear: one is a mixture of the others, so it sees no colours; use the "
                     "camera's own three curves");
  }
}

}  // namespace

Sides prepareSides(const TransformSpec& spec) {
  if (!(spec.adaptation >= 0.0 && spec.adaptation <= 1.0)) {
    throw InputError("", "adaptation", std::to_string(spec.adaptation), "give a number from 0 to 1");
  }
  Sides sides;
  sides.input = prepare(spec.input, spec.training, spec.standardObserver);
  sides.output = prepare(spec.output, spec.training, spec.standardObserver);
  refuseCollinear(spec.input, "input.observer");
  refuseCollinear(spec.output, "output.observer");
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

  const SideBalance inputBalance = balanceOf(spec, spec.input, input);
  const SideBalance outputBalance = balanceOf(spec, spec.output, output);
  if (inputBalance.hasDarkCones) {
    throw InputError(spec.input.illuminant.name(), "balanced", inputBalance.cones,
                     notReached("channel", inputBalance.cones));
  }
  if (spec.adaptation > 0.0 && outputBalance.hasDarkCones) {
    throw InputError(spec.output.illuminant.name(), "adaptation", std::to_string(spec.adaptation),
                     "the eye cannot adapt to this light with " + outputBalance.cones +
                         " (no response in one cone); use adaptation 0 or vonkries");
  }
  const Eigen::Vector3d white = spec.space.whiteXyz();
  const Eigen::Matrix3d relativeFromXyz = white.cwiseInverse().asDiagonal();
  sides.relativeFromResponse = inputBalance.relativeFromResponse * input.white.asDiagonal();
  sides.relativeFromOutputResponse = outputBalance.relativeFromResponse;
  sides.unseen = outputBalance.unseen;

  const Eigen::Matrix3d cones = spectral::lmsFromXyz(spec.cat);
  const Eigen::Array3d whiteCones = (cones * white).array();
  const Eigen::Array3d inputCones = (cones * input.whiteXyz()).array();
  const Eigen::Array3d outputCones = (cones * output.whiteXyz()).array();
  if (spec.adaptation < 1.0 && !(inputCones.minCoeff() > kDarkCone)) {
    throw InputError(spec.input.illuminant.name(), "cat", spectral::nameOf(spec.cat),
                     notReached("cone", spectral::nameOf(spec.cat)));
  }
  const auto onCones = [&](const Eigen::Array3d& gain) -> Eigen::Matrix3d {
    return cones.inverse() * gain.matrix().asDiagonal() * cones;
  };
  // The gain in cone space is D W / W_out + (1 - D) W / W_in: this much of full adaptation's.
  Eigen::Array3d degree = spec.adaptation + (1.0 - spec.adaptation) * outputCones / inputCones;
  Eigen::Array3d noAdaptation = whiteCones / inputCones;
  if (spec.balanced && spec.balanced->kind == Balance::Kind::None) {
    // The picture holds the light as it is, and so does the result.
    const Eigen::Matrix3d xyzFromNormalised = input.xyzFromResponse * input.white.asDiagonal();
    sides.responseFromRgb = xyzFromNormalised.inverse() * spec.space.xyzFromRgb();
    sides.relativeFromRgb = sides.relativeFromResponse * sides.responseFromRgb;
    degree /= noAdaptation;
    noAdaptation.setOnes();
  } else {
    sides.relativeFromRgb = relativeFromXyz * spec.space.xyzFromRgb();
    sides.responseFromRgb = sides.relativeFromResponse.inverse() * sides.relativeFromRgb;
  }
  const Eigen::Matrix3d rgbFromXyz = exposure * spec.space.rgbFromXyz();
  sides.rgbFromRelative = rgbFromXyz * onCones(degree) * white.asDiagonal();
  sides.rgbFromOutputResponse = sides.rgbFromRelative * sides.relativeFromOutputResponse;
  if (outputBalance.hasDarkCones) {  // where nothing can be adapted, and what full adaptation takes away is there
    sides.rgbFromOutputResponse = rgbFromXyz * onCones(noAdaptation) * output.xyzFromResponse;
  }
  return sides;
}

Eigen::Matrix3Xd Sides::inputWeights(int bandCount) const {
  return input.white.cwiseInverse().asDiagonal() * bandWeights(input.light, input.curves, bandCount);
}

Eigen::Matrix3Xd Sides::relativeWeights(int bandCount) const {
  return relativeFromOutputResponse * bandWeights(output.light, output.curves, bandCount);
}

}  // namespace metamer::sip
