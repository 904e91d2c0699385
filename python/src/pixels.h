// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <Eigen/Core>
#include <functional>
#include <span>

// Pixels: arrays whose last axis is red, green, blue and perhaps alpha, any number of axes before it, any strides.
namespace metamer::python {

namespace nb = nanobind;

template <typename Number>
using Pixels = nb::ndarray<const Number, nb::device::cpu>;

/// What is done to pixels, in both precisions.
struct PixelFunction {
  /// RGBA to RGBA; the two are one or do not overlap.
  std::function<void(std::span<const float> source, std::span<float> destination)> rgba;
  std::function<void(std::span<Eigen::Vector3d> colours)> colours;  ///< in place
};

/// Runs a function over pixels with the GIL released; alpha goes along as it is.
/// @param out  None: the result is a new array; else a writable array of the same shape and type, `pixels` itself or
///             one that shares no memory with it
/// @return the new array, or `out`
/// @throws nb::value_error: a shape that is no pixels, an `out` that does not fit
nb::object runOverPixels(const PixelFunction& function, const Pixels<float>& pixels, const nb::object& out);

/// The same for what is no array of float32: arrays of float64, numbers in sequences, which become that; arrays of
/// other types are refused.
nb::object runOverNumbers(const PixelFunction& function, const nb::object& numbers, const nb::object& out);

/// Adds __call__ to a class, with the signatures that type checkers see.
template <typename Class, typename FunctionOf>
void defineCall(Class& binding, const FunctionOf& functionOf, const char* documentation) {
  using Self = typename Class::Type;
  using namespace nb::literals;
  binding
      .def(
          "__call__",
          [functionOf](const Self& self, const Pixels<float>& pixels, const nb::object& out) {
            return runOverPixels(functionOf(self), pixels, out);
          },
          nb::arg("pixels").noconvert(), "out"_a = nb::none(),
          nb::sig("def __call__(self, pixels: numpy.typing.NDArray[metamer._types.Float], out: "
                  "numpy.typing.NDArray[metamer._types.Float] | None = None) -> "
                  "numpy.typing.NDArray[metamer._types.Float]"),
          documentation)
      .def(
          "__call__",
          [functionOf](const Self& self, const nb::object& numbers, const nb::object& out) {
            return runOverNumbers(functionOf(self), numbers, out);
          },
          "pixels"_a, "out"_a = nb::none(),
          nb::sig("def __call__(self, pixels: collections.abc.Sequence[float] | "
                  "collections.abc.Sequence[collections.abc.Sequence[float]], out: None = None) -> "
                  "numpy.typing.NDArray[numpy.float64]"));
}

}  // namespace metamer::python
