// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <Eigen/Core>
#include <vector>

#include "metamer/stage/non_negative_least_squares.h"

// What the parts of metamer.stage share: patches are rows in NumPy, columns in the engine.
namespace metamer::python {

namespace nb = nanobind;

void bindWall(nb::module_& module);
void bindMatch(nb::module_& module);

/// N x 3 numbers as 3 x N. @throws nb::value_error for another shape
Eigen::Matrix3Xd patchColumns(nb::handle rows, const char* what);
/// Several of them, of as many patches each.
std::vector<Eigen::Matrix3Xd> chartsOf(const nb::sequence& charts);

/// Limits of `count` drives; each of `upper` and `power` None, one number for all, or one a drive.
stage::DriveLimits limitsFrom(const nb::object& upper, const nb::object& power, const nb::object& budget,
                              Eigen::Index count);

}  // namespace metamer::python
