// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "metamer/spectral/observer.h"
#include "metamer/spectral/spectrum.h"

namespace metamer::sip {

/// A filter before the observer. Density 1 is the filter as measured, 0.5 half its dye, 2 two sheets
/// (Beer-Lambert: transmittance to the power of the density).
struct FilterLayer {
  spectral::Spectrum transmittance;
  double density = 1.0;
};

/// One side of the dual pipeline: light, filters, observer (course notes, section 5.2).
struct Pipeline {
  spectral::Spectrum illuminant;
  std::vector<FilterLayer> filters;
  spectral::Observer observer;
};

/// A pipeline made ready: what reaches the observer, scaled so that the perfect reflector has Y = 1 (camera: mean of
/// the channels 1).
struct PreparedPipeline {
  spectral::DomainSamples light;                           ///< illuminant times filters, scaled
  Eigen::Matrix<double, spectral::kDomainSize, 3> curves;  ///< observer, as this light sees it (spectral::SeenLight)
  Eigen::Vector3d white;                                   ///< response to the perfect reflector
  Eigen::Matrix3d xyzFromResponse;                         ///< scaled so that white has Y = 1
  double filterTransmission = 1.0;                         ///< Y with the filters over Y without

  Eigen::Vector3d whiteXyz() const { return xyzFromResponse * white; }
};

/// @param training  reflectances (domain samples) over which an unknown matrix from response to XYZ is solved by least
///                  squares under this pipeline's light, the CIE observer seeing the same light
/// @param standardObserver  the CIE observer of that solve
/// @throws spectral::InputError  where no light reaches the observer (names the illuminant and filters)
PreparedPipeline prepare(const Pipeline& pipeline, const std::vector<spectral::DomainSamples>& training,
                         const spectral::Observer& standardObserver);

}  // namespace metamer::sip
