// SPDX-License-Identifier: Apache-2.0
#include "stage.h"

#include <nanobind/stl/string.h>

#include <string>

#include "arrays.h"
#include "bindings.h"
#include "metamer/stage/emitter_model.h"
#include "metamer/stage/panel_linearity.h"
#include "metamer/stage/stage_geometry.h"

using namespace nanobind::literals;

namespace metamer::python {
namespace {

Eigen::VectorXd spread(const nb::object& numbers, Eigen::Index count, const char* what) {
  if (numbers.is_none()) {
    return {};
  }
  const Doubles array = doubles(numbers);
  if (array.size() == 1) {
    return Eigen::VectorXd::Constant(count, *array.data());
  }
  if (array.ndim() != 1 || static_cast<Eigen::Index>(array.size()) != count) {
    throw nb::value_error((std::string(what) + ": must be one number, or one a drive").c_str());
  }
  return Eigen::Map<const Eigen::VectorXd>(array.data(), count);
}

nb::dict linearity(nb::handle drives, nb::handle rgb) {
  const Doubles sent = doubles(drives);
  const stage::DriveSeries series{{sent.data(), sent.data() + sent.size()}, patchColumns(rgb, "rgb")};
  if (static_cast<Eigen::Index>(series.drives.size()) != series.rgb.cols()) {
    throw nb::value_error("rgb: must have a row a drive");
  }
  const stage::PanelLinearity found = stage::judgeLinearity(series);
  nb::dict result;
  result["gain"] = found.gain;
  result["black"] = found.black;
  result["exponent"] = found.exponent;
  result["deviation"] = found.deviation;
  result["worst_drive"] = found.worstDrive;
  result["hue_drift"] = found.hueDrift;
  return result;
}

}  // namespace

Eigen::Matrix3Xd patchColumns(nb::handle rows, const char* what) {
  const Doubles array = doubles(rows);
  if (array.ndim() != 2 || array.shape(1) != 3) {
    throw nb::value_error((std::string(what) + ": must be a row of three numbers a patch").c_str());
  }
  return Eigen::Map<const Eigen::Matrix3Xd>(array.data(), 3, static_cast<Eigen::Index>(array.shape(0)));
}

std::vector<Eigen::Matrix3Xd> chartsOf(const nb::sequence& charts) {
  std::vector<Eigen::Matrix3Xd> result;
  for (const nb::handle chart : charts) {
    result.push_back(patchColumns(chart, "charts"));
    if (result.back().cols() != result.front().cols()) {
      throw nb::value_error("charts: must have the same patches");
    }
  }
  return result;
}

stage::DriveLimits limitsFrom(const nb::object& upper, const nb::object& power, const nb::object& budget,
                              Eigen::Index count) {
  stage::DriveLimits limits;
  limits.upper = spread(upper, count, "upper");
  limits.power = spread(power, count, "power");
  if (!budget.is_none()) {
    if (power.is_none()) {
      throw nb::value_error("power_budget: needs power, the power of each drive at 1");
    }
    limits.powerBudget = nb::cast<double>(nb::float_(budget));
  }
  return limits;
}

void bindStage(nb::module_& module) {
  bindWall(module);
  bindMatch(module);
  bindConfidence(module);
  module.def("calibration_square_beta", &stage::calibrationSquareBeta, "width"_a, "height"_a, "distance"_a,
             "Light of a whole sphere over that of a lit square before a parallel chart: 4.18 for 1 x 1 at 1.");
  module.def("led_model", &stage::ledModel, "peak"_a, "width"_a,
             "A single-colour LED as a model (Ohno 2005): peak and half spectral width in nm.");
  module.def("phosphor_model", &stage::phosphorModel, "pump"_a, "pump_width"_a, "peak"_a, "width"_a, "pump_share"_a,
             "A phosphor-converted LED as a model: the pump LED, and a Gaussian of a full width at half maximum.");
  module.def(
      "panel_linearity", &linearity, "drives"_a, "rgb"_a,
      nb::sig("def panel_linearity(drives: numpy.typing.ArrayLike, rgb: numpy.typing.ArrayLike) -> dict[str, float]"),
      "Whether a panel's light is proportional to what is sent: a row of linear camera RGB a drive.");
}

}  // namespace metamer::python
