// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "metamer/sip/spectral_transform.h"
#include "metamer/spectral/data_library.h"

namespace metamer::lutgen {

/// A measured surface under both lights of a recipe: linear RGB of its space, CIEDE2000 from the truth.
struct KnownSurface {
  std::string name;
  Eigen::Vector3d asShot;
  Eigen::Vector3d engine;
  Eigen::Vector3d truth;  ///< what the output side makes of its spectrum
  Eigen::Vector3d plain;  ///< by plain adaptation
  double engineError = 0;
  double plainError = 0;
  /// How much noise grows that is even and equal in red, green and blue: root mean square out over in.
  double noise = 0;
  double plainNoise = 0;
};

struct SurfaceGroup {
  std::string title;
  std::vector<KnownSurface> surfaces;
};

/// Means over a group.
struct GroupMeans {
  double engine = 0;
  double plain = 0;
  double noise = 0;
  double plainNoise = 0;
};
GroupMeans meansOf(const SurfaceGroup& group);

/// Skin, the chart of the error protocol, and leaves of other sets (metamer/validation/foliage.h).
std::vector<SurfaceGroup> knownSurfaces(const sip::TransformSpec& spec, const sip::SpectralTransform& transform,
                                        const spectral::DataLibrary& library);

}  // namespace metamer::lutgen
