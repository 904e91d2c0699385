// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>

#include "metamer/spectral/rgb_space.h"

namespace metamer::spectral {

/// The cone-like space in which white is scaled to white.
enum class ChromaticAdaptation {
  VonKries,  ///< Hunt-Pointer-Estevez, normalised to D65 (Hunt 1991); the default
  Bradford,  ///< Lam 1985, linear part
  Cat02,     ///< CIECAM02, Moroney et al. 2002
  Cat16,     ///< CAM16, Li et al. 2017
};

/// "vonkries", "bradford", "cat02", "cat16". @throws InputError for any other name (lists these)
ChromaticAdaptation chromaticAdaptationFromName(const std::string& name);
std::string nameOf(ChromaticAdaptation method);

/// Cone-like response from XYZ, rows.
Eigen::Matrix3d lmsFromXyz(ChromaticAdaptation method);

/// XYZ under `destinationWhite` from XYZ under `sourceWhite`, full adaptation.
/// Both whites are tristimuli with positive cone response. @throws InputError otherwise
Eigen::Matrix3d adaptXyz(ChromaticAdaptation method, const Eigen::Vector3d& sourceWhite,
                         const Eigen::Vector3d& destinationWhite);

/// Linear RGB of one space from that of another, full adaptation from white to white. @throws InputError as adaptXyz
Eigen::Matrix3d adaptRgb(ChromaticAdaptation method, const RgbSpace& source, const RgbSpace& destination);

}  // namespace metamer::spectral
