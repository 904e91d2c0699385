// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>

#include "metamer/spectral/spectrum.h"

namespace metamer::spectral {

/// Three response curves: an eye's colour matching functions or a camera's sensitivities.
struct Observer {
  enum class Response {
    Xyz,     ///< CIE colour matching functions: the response is X, Y, Z
    Lms,     ///< cone fundamentals
    Camera,  ///< camera sensitivities: the response is R, G, B
  };

  std::string name;
  Response response = Response::Xyz;
  std::array<Spectrum, 3> curves;
  /// XYZ from this response, rows; identity for Response::Xyz, published for some cameras, else empty:
  /// it is then solved for the light at hand.
  std::optional<Eigen::Matrix3d> xyzFromResponse;

  /// 401 x 3, one column a curve, on the integration domain.
  Eigen::Matrix<double, kDomainSize, 3> onDomain() const;
};

}  // namespace metamer::spectral
