// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include "metamer/spectral/data_library.h"

// The parts of the module metamer._core, one source file each.
namespace metamer::python {

namespace nb = nanobind;

void bindErrors(nb::module_& module);
void bindSpectra(nb::module_& module);
void bindLibrary(nb::module_& module);
void bindColorimetry(nb::module_& module);
void bindRecipe(nb::module_& module);
void bindTransform(nb::module_& module);
void bindComparison(nb::module_& module);
void bindStage(nb::module_& module);
void bindSkin(nb::module_& module);
void bindUplift(nb::module_& module);

/// `library`, or where it is None the tables of $METAMER_DATA, else those that lie beside the module.
/// @throws spectral::InputError where there are none
const spectral::DataLibrary& libraryOr(const spectral::DataLibrary* library);

}  // namespace metamer::python
