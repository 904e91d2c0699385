// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/pipeline.h"

#include <Eigen/QR>
#include <cmath>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/spectral_integral.h"

namespace metamer::sip {

using spectral::InputError;

namespace {

Eigen::Vector3d respond(const spectral::DomainSamples& light,
                        const Eigen::Matrix<double, spectral::kDomainSize, 3>& curves) {
  return curves.transpose() * light;
}

/// The component that carries luminance: Y, or for cones and cameras the mean.
double level(const Eigen::Vector3d& response, spectral::Observer::Response kind) {
  return kind == spectral::Observer::Response::Xyz ? response.y() : response.mean();
}

std::string describe(const Pipeline& pipeline) {
  std::string text = pipeline.illuminant.name();
  for (const auto& filter : pipeline.filters) {
    text += " through " + filter.transmittance.name();
  }
  return text;
}

/// XYZ from response by least squares over the training reflectances, both under `light`.
Eigen::Matrix3d solveXyzFromResponse(const spectral::DomainSamples& light,
                                     const Eigen::Matrix<double, spectral::kDomainSize, 3>& curves,
                                     const std::vector<spectral::DomainSamples>& training,
                                     const spectral::Observer& standardObserver) {
  const auto count = static_cast<Eigen::Index>(training.size());
  Eigen::MatrixX3d responses(count, 3);
  Eigen::MatrixX3d tristimuli(count, 3);
  const auto standardCurves = standardObserver.onDomain();
  for (Eigen::Index i = 0; i < count; ++i) {
    const spectral::DomainSamples reflected = training[static_cast<std::size_t>(i)].cwiseProduct(light);
    responses.row(i) = respond(reflected, curves).transpose();
    tristimuli.row(i) = respond(reflected, standardCurves).transpose();
  }
  return responses.completeOrthogonalDecomposition().solve(tristimuli).transpose();
}

}  // namespace

PreparedPipeline prepare(const Pipeline& pipeline, const std::vector<spectral::DomainSamples>& training,
                         const spectral::Observer& standardObserver) {
  PreparedPipeline prepared;
  std::vector<spectral::WeighedFilter> filters;
  for (const auto& filter : pipeline.filters) {
    if (!(filter.density >= 0.0) || !std::isfinite(filter.density)) {
      throw InputError(filter.transmittance.name(), "density", std::to_string(filter.density),
                       "a density is a number from 0 (no filter) up");
    }
    filters.push_back({filter.transmittance, filter.density});
  }
  const spectral::SeenLight bare = spectral::seenLight(pipeline.illuminant, {}, pipeline.observer);
  const spectral::SeenLight seen =
      filters.empty() ? bare : spectral::seenLight(pipeline.illuminant, filters, pipeline.observer);
  prepared.light = seen.light;
  prepared.curves = seen.curves;
  const auto kind = pipeline.observer.response;
  const double unfiltered = level(respond(bare.light, bare.curves), kind);
  const double filtered = level(respond(prepared.light, prepared.curves), kind);
  if (!(unfiltered > 0.0)) {
    throw InputError(
        "", "illuminant", pipeline.illuminant.name(),
        "gives the observer " + pipeline.observer.name + " nothing between 380 and 780 nm; name another light");
  }
  if (!(filtered > 1e-12 * unfiltered)) {
    throw InputError(describe(pipeline), "filters", std::to_string(pipeline.filters.size()),
                     "the filters stop all the light; lower a density or take one away");
  }
  prepared.filterTransmission = filtered / unfiltered;
  prepared.light /= filtered;
  prepared.white = respond(prepared.light, prepared.curves);
  prepared.xyzFromResponse = pipeline.observer.xyzFromResponse.value_or(Eigen::Matrix3d::Zero());
  if (!pipeline.observer.xyzFromResponse) {
    if (training.size() < 3) {
      throw InputError(pipeline.observer.name, "training", std::to_string(training.size()),
                       "an observer without a matrix to XYZ needs at least three training reflectances");
    }
    prepared.xyzFromResponse = solveXyzFromResponse(prepared.light, prepared.curves, training, standardObserver);
  }
  const double luminance = prepared.whiteXyz().y();
  if (!(luminance > 0.0)) {
    throw InputError(pipeline.observer.name, "observer", describe(pipeline),
                     "this observer's matrix gives white no luminance under this light");
  }
  prepared.xyzFromResponse /= luminance;
  return prepared;
}

}  // namespace metamer::sip
