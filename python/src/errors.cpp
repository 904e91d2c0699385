// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"
#include "metamer/spectral/missing_file_error.h"

namespace metamer::python {

void bindErrors(nb::module_& /*module*/) {
  nb::register_exception_translator([](const std::exception_ptr& thrown, void* /*payload*/) {
    try {
      std::rethrow_exception(thrown);
    } catch (const spectral::MissingFileError& error) {
      PyErr_SetString(PyExc_FileNotFoundError, error.what());
    } catch (const spectral::InputError& error) {
      PyErr_SetString(PyExc_ValueError, error.what());
    }
  });
}

}  // namespace metamer::python
