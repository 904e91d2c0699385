// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "metamer/spectral/observer.h"
#include "metamer/spectral/spectrum.h"

namespace metamer::spectral {

/// A filter in the light's way.
struct WeighedFilter {
  const Spectrum& transmittance;
  double density = 1.0;  ///< the transmittance goes to this power
};

/// Whether the plain sum over 380, 381, ..., 780 nm stands for the integral of a table. For a light: an even table at
/// whole nanometres, five or more apart over 100 nm or more, as the CIE prints lights: within 3e-5 in xy of the
/// integral, and what CIE 015 asks for; or the samples of a formula. For all else: samples at whole nanometres.
bool isSummed(const Spectrum& spectrum);

/// What each nanometre of a light counts for: Spectrum::onDomain() of a light. Where isSummed(), its samples; else the
/// integrals of hat_i times the light, hat_i rising linearly from 0 at i - 1 to 1 at i nm and falling to 0 at i + 1:
/// their sum over i times samples of a curve is the exact integral of light times curve, both piecewise linear.
DomainSamples lightOnDomain(const Spectrum& light);

/// Light, filters and observer together on the domain.
struct SeenLight {
  DomainSamples light;                           ///< through the filters
  Eigen::Matrix<double, kDomainSize, 3> curves;  ///< of the observer, as seen by this light
};

/// light[i] curves(i, k) is the integral of hat_i times light times filters times curve k, exact over the union of
/// their samples' wavelengths: a line of any width has its energy and its place. Where all tables are summed, the
/// product of their samples.
SeenLight seenLight(const Spectrum& light, const std::vector<WeighedFilter>& filters, const Observer& observer);

}  // namespace metamer::spectral
