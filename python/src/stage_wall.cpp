// SPDX-License-Identifier: Apache-2.0
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <string>
#include <vector>

#include "arrays.h"
#include "bindings.h"
#include "metamer/stage/rgb_wall.h"
#include "metamer/stage/skin_priority.h"
#include "metamer/stage/wall_spectra.h"
#include "spectrum_like.h"
#include "stage.h"

using namespace nanobind::literals;

namespace metamer::python {
namespace {

using stage::WallCapture;
using stage::WallSolution;

std::vector<std::string> namesOf(const nb::object& names, Eigen::Index count) {
  std::vector<std::string> result;
  if (names.is_none()) {
    for (Eigen::Index i = 0; i < count; ++i) {
      result.push_back("patch " + std::to_string(i));
    }
    return result;
  }
  result = nb::cast<std::vector<std::string>>(names);
  if (static_cast<Eigen::Index>(result.size()) != count) {
    throw nb::value_error("names: must be one a patch");
  }
  return result;
}

WallCapture captureFrom(nb::handle primaries, const nb::sequence& charts, nb::handle target, nb::handle white,
                        double beta, nb::handle blackLevel, const nb::object& names) {
  const std::vector<Eigen::Matrix3Xd> lit = chartsOf(charts);
  const Eigen::Matrix3Xd wanted = patchColumns(target, "target");
  if (lit.size() != 3 || lit[0].cols() != wanted.cols()) {
    throw nb::value_error("charts: must be three, of the target's patches");
  }
  return {matrix3(primaries, "primaries").transpose(),
          {lit[0], lit[1], lit[2]},
          wanted,
          namesOf(names, wanted.cols()),
          vector3(white, "environment_white"),
          beta,
          vector3(blackLevel, "black_level")};
}

WallCapture captureFromSpectra(const nb::sequence& emitters, nb::handle camera, nb::handle target,
                               nb::handle reflectances, double beta) {
  if (nb::len(emitters) != 3) {
    throw nb::value_error("emitters: must be three: red, green, blue");
  }
  stage::WallSpectra spectra;
  for (std::size_t k = 0; k < 3; ++k) {
    spectra.emitters[k] = lightFrom(nb::object(emitters[k])).onDomain();
  }
  spectra.camera = namedObserverFrom(camera).onDomain();
  spectra.reflectances = reflectancesFrom(reflectances);
  spectra.target = lightFrom(target).onDomain();
  spectra.beta = beta;
  return stage::captureOf(spectra);
}

WallSolution solve(const WallCapture& capture, const nb::object& heldPatch, const nb::object& patchWeights,
                   double largestCondition, const WallCapture* skins, double skinWeight) {
  return stage::solveWall(capture,
                          wallOptionsFrom(capture, heldPatch, patchWeights, largestCondition, skins, skinWeight));
}

template <typename Binding, typename Owner, typename Member>
void matrixField(Binding& binding, const char* name, Member Owner::*member, const char* documentation) {
  binding.def_prop_ro(
      name, [member](const Owner& self) { return newMatrix(self.*member); }, documentation);
}

template <typename Binding, typename Owner>
void vectorField(Binding& binding, const char* name, Eigen::Vector3d Owner::*member, const char* documentation) {
  binding.def_prop_ro(
      name, [member](const Owner& self) { return newVector(self.*member); }, documentation);
}

void bindCapture(nb::module_& module) {
  nb::class_<WallCapture> capture(module, "WallCapture",
                                  "What the camera saw of an RGB wall, in its linear RGB; a row a patch.");
  capture
      .def(
          "__init__",
          [](WallCapture* self, nb::handle primaries, const nb::sequence& charts, nb::handle target, nb::handle white,
             double beta, nb::handle blackLevel, const nb::object& names) {
            new (self) WallCapture(captureFrom(primaries, charts, target, white, beta, blackLevel, names));
          },
          nb::kw_only(), "primaries"_a, "charts"_a, "target"_a, "environment_white"_a, "beta"_a = 1.0,
          "black_level"_a = nb::make_tuple(0, 0, 0), "names"_a = nb::none(),
          nb::sig("def __init__(self, *, primaries: numpy.typing.ArrayLike, charts: "
                  "collections.abc.Sequence[numpy.typing.ArrayLike], target: numpy.typing.ArrayLike, "
                  "environment_white: numpy.typing.ArrayLike, beta: float = 1.0, black_level: "
                  "numpy.typing.ArrayLike = (0, 0, 0), names: collections.abc.Sequence[str] | None = None) -> None"),
          "`primaries`: rows are the wall's red, green and blue. `charts`: the chart under each of them before the\n"
          "calibration square. `target`: the chart in the real place. `environment_white`: what a white chart sends\n"
          "back there. `beta`: see calibration_square_beta.")
      .def_static("from_spectra", &captureFromSpectra, "emitters"_a, nb::kw_only(), "camera"_a, "target"_a,
                  "reflectances"_a = "colorchecker", "beta"_a = 1.0,
                  nb::sig("def from_spectra(emitters: collections.abc.Sequence[metamer._types.NamedSpectrum], *, "
                          "camera: metamer._types.NamedObserver, target: metamer._types.NamedSpectrum, reflectances: "
                          "metamer._types.File | collections.abc.Iterable[metamer._types.SpectrumLike] = "
                          "'colorchecker', beta: float = 1.0) -> WallCapture"),
                  "The capture that a camera would make of a wall whose spectra are known.")
      .def_prop_ro("names", [](const WallCapture& self) { return self.patchNames; })
      .def_prop_ro("primaries", [](const WallCapture& self) { return newMatrix(self.cameraFromWall.transpose()); })
      .def_prop_ro("target", [](const WallCapture& self) { return newMatrix(self.target.transpose()); })
      .def_prop_ro("charts",
                   [](const WallCapture& self) {
                     std::vector<NumpyDoubles> charts;
                     for (const Eigen::Matrix3Xd& chart : self.charts) {
                       charts.push_back(newMatrix(chart.transpose()));
                     }
                     return charts;
                   })
      .def_ro("beta", &WallCapture::beta);
  vectorField(capture, "environment_white", &WallCapture::environmentWhite, "");
  vectorField(capture, "black_level", &WallCapture::blackLevel, "");
}

void bindSolution(nb::module_& module) {
  nb::class_<WallSolution> solution(module, "WallSolution", "An RGB wall's matrices (docs/led_stage.md).");
  matrixField(solution, "M", &WallSolution::wallFromContent, "Out of frustum: wall drives from camera RGB.");
  matrixField(solution, "Q", &WallSolution::correctedFromCamera, "After the camera.");
  matrixField(solution, "N", &WallSolution::frustumFromContent, "In frustum: M with Q undone.");
  vectorField(solution, "offset", &WallSolution::frustumOffset, "Added to what N gives; drives then never below 0.");
  vectorField(solution, "environment_drive", &WallSolution::environmentDrive, "Of the environment's white.");
  vectorField(solution, "environment_drive_asked", &WallSolution::environmentDriveAsked,
              "The same with what is out of reach below 0.");
  solution
      .def_prop_ro(
          "predicted", [](const WallSolution& self) { return newMatrix(self.predicted.transpose()); },
          "The chart on the stage, a row a patch.")
      .def_prop_ro(
          "corrected", [](const WallSolution& self) { return newMatrix(self.corrected.transpose()); },
          "The same after Q.")
      .def_prop_ro(
          "corrected_skins", [](const WallSolution& self) { return newMatrix(self.correctedSkins.transpose()); },
          "The skins after Q, a row each; none without skins.")
      .def_ro("wall_condition", &WallSolution::wallCondition)
      .def_ro("chart_condition", &WallSolution::chartCondition)
      .def_ro("Q_condition", &WallSolution::correctionCondition)
      .def_ro("chart_rank", &WallSolution::chartRank, "Independent patches, at most 3.")
      .def_ro("N_bounded", &WallSolution::bounded, "Q is nearly of rank one, and N is bounded.");
}

}  // namespace

Eigen::Matrix3d matrix3(nb::handle numbers, const char* what) {
  const Doubles array = doubles(numbers);
  if (array.ndim() != 2 || array.shape(0) != 3 || array.shape(1) != 3) {
    throw nb::value_error((std::string(what) + ": must be 3 x 3").c_str());
  }
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(array.data());
}

int patchOf(const WallCapture& capture, const nb::object& patch, const char* what) {
  if (patch.is_none()) {
    return -1;
  }
  const auto& names = capture.patchNames;
  const int number =
      nb::isinstance<nb::str>(patch)
          ? static_cast<int>(std::find(names.begin(), names.end(), nb::cast<std::string>(patch)) - names.begin())
          : nb::cast<int>(patch);
  if (number < 0 || number >= capture.target.cols()) {
    throw nb::value_error((std::string(what) + ": must be the name or the number of one of the patches").c_str());
  }
  return number;
}

stage::WallOptions wallOptionsFrom(const WallCapture& capture, const nb::object& heldPatch,
                                   const nb::object& patchWeights, double largestCondition, const WallCapture* skins,
                                   double skinWeight) {
  stage::WallOptions options;
  options.largestCondition = largestCondition;
  if (skins != nullptr) {
    options.skins = *skins;
    options.skinWeight = skinWeight;
  }
  options.heldPatch = patchOf(capture, heldPatch, "held_patch");
  if (!patchWeights.is_none()) {
    const Doubles weights = doubles(patchWeights);
    if (weights.ndim() != 1 || static_cast<Eigen::Index>(weights.size()) != capture.target.cols()) {
      throw nb::value_error("patch_weights: must be one a patch");
    }
    options.patchWeights = Eigen::Map<const Eigen::VectorXd>(weights.data(), static_cast<Eigen::Index>(weights.size()));
  }
  return options;
}

void bindWall(nb::module_& module) {
  bindCapture(module);
  bindSolution(module);
  module.def(
      "solve_wall", &solve, "capture"_a, nb::kw_only(), "held_patch"_a = nb::none(), "patch_weights"_a = nb::none(),
      "largest_condition"_a = stage::kDefaultLargestCondition, "skins"_a.none() = nb::none(),
      "skin_weight"_a = stage::kDefaultSkinWeight,
      nb::sig("def solve_wall(capture: WallCapture, *, held_patch: int | str | None = None, patch_weights: "
              "numpy.typing.ArrayLike | None = None, largest_condition: float = 100.0, skins: WallCapture | None = "
              "None, skin_weight: float = 6.0) -> WallSolution"),
      "M, Q, N and the black offset of an RGB wall. `held_patch` keeps its colour exactly. `skins`: the same wall and\n"
      "place with skins for a chart (from_spectra(..., reflectances=\"virtual skins\")), each of which counts\n"
      "`skin_weight` beside a patch's 1.");
}

}  // namespace metamer::python
