// SPDX-License-Identifier: Apache-2.0
#include "arrays.h"

#include <algorithm>
#include <string>

namespace metamer::python {
namespace {

std::string shapeText(const Doubles& array) {
  std::string text = "(";
  for (std::size_t i = 0; i < array.ndim(); ++i) {
    text += (i > 0 ? ", " : "") + std::to_string(array.shape(i));
  }
  return text + (array.ndim() == 1 ? ",)" : ")");
}

}  // namespace

Doubles doubles(nb::handle numbers) {
  const nb::module_ numpy = nb::module_::import_("numpy");
  return nb::cast<Doubles>(numpy.attr("ascontiguousarray")(numbers, numpy.attr("float64")));
}

NumpyDoubles newVector(const Eigen::Ref<const Eigen::VectorXd>& vector) {
  return newDoubles({static_cast<std::size_t>(vector.size())},
                    [&](double* data) { std::copy(vector.begin(), vector.end(), data); });
}

NumpyDoubles newMatrix(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return newDoubles({static_cast<std::size_t>(matrix.rows()), static_cast<std::size_t>(matrix.cols())},
                    [&](double* data) { Eigen::Map<RowMajor>(data, matrix.rows(), matrix.cols()) = matrix; });
}

Eigen::Vector3d vector3(nb::handle numbers, const char* what) {
  const Doubles array = doubles(numbers);
  if (array.ndim() != 1 || array.shape(0) != 3) {
    throw nb::value_error((std::string(what) + ": shape " + shapeText(array) + ": must be three numbers").c_str());
  }
  return {array.data()[0], array.data()[1], array.data()[2]};
}

std::vector<std::size_t> shapeOfColours(const Doubles& colours, const char* what) {
  if (colours.ndim() == 0 || colours.shape(colours.ndim() - 1) != 3) {
    throw nb::value_error(
        (std::string(what) + ": shape " + shapeText(colours) + ": the last axis must have three components").c_str());
  }
  std::vector<std::size_t> shape(colours.ndim());
  for (std::size_t i = 0; i < shape.size(); ++i) {
    shape[i] = colours.shape(i);
  }
  return shape;
}

}  // namespace metamer::python
