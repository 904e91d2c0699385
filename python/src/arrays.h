// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

// Small arrays of doubles: colours, spectra, matrices. Pixels have a header of their own.
namespace metamer::python {

namespace nb = nanobind;

/// Doubles in C order, a copy where the caller's were anything else.
using Doubles = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;

inline bool isArray(PyObject* object) {
  return nb::ndarray_check(object);
}

/// A new NumPy array of doubles, typed for the stubs. (An nb::ndarray cannot be a property's value: it has an owner.)
class NumpyDoubles : public nb::object {
 public:
  NB_OBJECT(NumpyDoubles, nb::object, "numpy.typing.NDArray[numpy.float64]", isArray)
};

/// Whatever NumPy makes an array of numbers of.
Doubles doubles(nb::handle numbers);

/// A new array of a shape, its memory its own; `fill` writes its doubles.
template <typename Fill>
NumpyDoubles newDoubles(const std::vector<std::size_t>& shape, const Fill& fill) {
  std::size_t size = 1;
  for (const std::size_t length : shape) {
    size *= length;
  }
  auto memory = std::make_unique<double[]>(size);
  fill(memory.get());
  double* const data = memory.release();
  const nb::capsule owner(data, [](void* pointer) noexcept { delete[] static_cast<double*>(pointer); });
  const nb::ndarray<nb::numpy, double> array(data, shape.size(), shape.data(), owner);
  return nb::steal<NumpyDoubles>(nb::cast(array).release());
}

NumpyDoubles newVector(const Eigen::Ref<const Eigen::VectorXd>& vector);
/// Row by row, as NumPy has it.
NumpyDoubles newMatrix(const Eigen::Ref<const Eigen::MatrixXd>& matrix);

/// Three numbers. @param what  for the message @throws nb::value_error for any other shape
Eigen::Vector3d vector3(nb::handle numbers, const char* what);

/// The shape of an array whose last axis has three components.
/// @throws nb::value_error for any other
std::vector<std::size_t> shapeOfColours(const Doubles& colours, const char* what);

}  // namespace metamer::python
