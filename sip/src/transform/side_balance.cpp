// SPDX-License-Identifier: Apache-2.0
#include "transform/side_balance.h"

#include <Eigen/LU>

#include "metamer/spectral/input_error.h"

namespace metamer::sip {

namespace {

using Kind = Balance::Kind;

/// A cone or channel of white has no light where it is not above this.
constexpr double kDark = 1e-9;

/// Gains in the space of `cones`, from XYZ.
SideBalance byCones(const Eigen::Matrix3d& cones, const Eigen::Vector3d& white, const PreparedPipeline& prepared) {
  const Eigen::Array3d from = (cones * prepared.whiteXyz()).array();
  const Eigen::Array3d to = (cones * white).array();
  const Eigen::Array3d dark = (from <= kDark).cast<double>();
  const Eigen::Array3d gain = (1.0 - dark) * to / (from * (1.0 - dark) + dark);
  const Eigen::Matrix3d relativeFromCones = white.cwiseInverse().asDiagonal() * cones.inverse();
  return {.relativeFromResponse = relativeFromCones * gain.matrix().asDiagonal() * cones * prepared.xyzFromResponse,
          .unseen = relativeFromCones * dark.matrix().asDiagonal() * cones * white.asDiagonal(),
          .hasDarkCones = dark.any(),
          .cones = {}};
}

/// Gains on the camera's own channels, then what balances its pictures in daylight.
SideBalance byChannels(const TransformSpec& spec, const Pipeline& pipeline, const PreparedPipeline& prepared) {
  if (!spec.daylight) {
    throw spectral::InputError(pipeline.observer.name, "balanced", "camera",
                               "needs the daylight that the camera's matrix is made for");
  }
  if (!(prepared.white.minCoeff() > kDark * prepared.white.maxCoeff())) {
    throw spectral::InputError(pipeline.illuminant.name(), "observer", pipeline.observer.name,
                               "gets nothing from this light in one of its channels; use another observer or light");
  }
  const PreparedPipeline daylight =
      prepare({*spec.daylight, {}, pipeline.observer}, spec.training, spec.standardObserver);
  SideBalance balance =
      byCones(spectral::lmsFromXyz(spectral::ChromaticAdaptation::Bradford), spec.space.whiteXyz(), daylight);
  balance.relativeFromResponse *= daylight.white.cwiseQuotient(prepared.white).asDiagonal();
  return balance;
}

}  // namespace

SideBalance balanceOf(const TransformSpec& spec, const Pipeline& pipeline, const PreparedPipeline& prepared) {
  const Balance balance = spec.balanced.value_or(Balance{.kind = Kind::Cat, .cat = spec.cat});
  const auto byCat = [&](spectral::ChromaticAdaptation cat) {
    SideBalance result = byCones(spectral::lmsFromXyz(cat), spec.space.whiteXyz(), prepared);
    result.cones = spectral::nameOf(cat);
    return result;
  };
  switch (balance.kind) {
    case Kind::Cat:
      return byCat(balance.cat);
    case Kind::Camera: {
      if (pipeline.observer.response != spectral::Observer::Response::Camera) {
        return byCat(spectral::ChromaticAdaptation::Bradford);
      }
      SideBalance result = byChannels(spec, pipeline, prepared);
      result.cones = nameOf(balance);
      return result;
    }
    case Kind::Rgb: {
      SideBalance result = byCones(spec.space.rgbFromXyz(), spec.space.whiteXyz(), prepared);
      result.cones = nameOf(balance);
      return result;
    }
    case Kind::None:
      break;
  }
  return byCat(spec.cat);
}

}  // namespace metamer::sip
