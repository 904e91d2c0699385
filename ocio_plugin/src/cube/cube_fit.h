// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "cube/cube_samples.h"

namespace metamer::ocio {

/// Node values of a 3-D table solved for least CIEDE2000 over samples, in place of the transform's own values there.
///
/// Sparse least squares in a perceptual metric, by tetrahedral weights, repeated with more weight on what is far off,
/// until the errors that count toward the 99th percentile are as small as the lattice allows. Nodes on the neutral
/// diagonal keep their values. What nodes move by is smooth from one to the next; those that no sample touches follow
/// their neighbours. No node lies above 1 unless the transform's own value there does, nor below the lowest signal that
/// any sample or neutral becomes.
/// @param nodes      in: the transform's own values, signal, red fastest. out: the fit
/// @param samples    ordered by node
/// @param belowZero  false: no node lies below 0 either, for tables that cannot hold it
void fitCube(std::vector<Eigen::Vector3f>& nodes, int size, const std::vector<CubeSample>& samples,
             const CubeJudge& judge, bool belowZero);

}  // namespace metamer::ocio
