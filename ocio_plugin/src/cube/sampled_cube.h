// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "metamer/ocio/signal.h"
#include "metamer/sip/spectral_transform.h"

namespace metamer::ocio {

/// The transform's own values at the nodes of a table over 0 ... 1, red fastest.
/// @param axes    of the table
/// @param signal  of the values
std::vector<Eigen::Vector3f> sampledCube(const sip::SpectralTransform& transform, const Signal& axes,
                                         const Signal& signal, int size);

}  // namespace metamer::ocio
