// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <Eigen/Core>
#include <vector>

#include "metamer/stage/non_negative_least_squares.h"
#include "metamer/stage/rgb_wall.h"

// What the parts of metamer.stage share: patches are rows in NumPy, columns in the engine.
namespace metamer::python {

namespace nb = nanobind;

void bindWall(nb::module_& module);
void bindMatch(nb::module_& module);
void bindConfidence(nb::module_& module);

/// N x 3 numbers as 3 x N. @throws nb::value_error for another shape
Eigen::Matrix3Xd patchColumns(nb::handle rows, const char* what);
/// Several of them, of as many patches each.
std::vector<Eigen::Matrix3Xd> chartsOf(const nb::sequence& charts);

/// Limits of `count` drives; each of `upper` and `power` None, one number for all, or one a drive.
stage::DriveLimits limitsFrom(const nb::object& upper, const nb::object& power, const nb::object& budget,
                              Eigen::Index count);

/// A patch by its name or number; -1 for None. @throws nb::value_error for one that is not there
int patchOf(const stage::WallCapture& capture, const nb::object& patch, const char* what);

/// 3 x 3 numbers. @throws nb::value_error for another shape
Eigen::Matrix3d matrix3(nb::handle numbers, const char* what);

/// What solve() is told beside the capture. @throws nb::value_error for patches and weights that do not fit it
stage::WallOptions wallOptionsFrom(const stage::WallCapture& capture, const nb::object& heldPatch,
                                   const nb::object& patchWeights, double largestCondition,
                                   const stage::WallCapture* skins, double skinWeight);

}  // namespace metamer::python
