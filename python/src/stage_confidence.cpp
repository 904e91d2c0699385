// SPDX-License-Identifier: Apache-2.0
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arrays.h"
#include "bindings.h"
#include "metamer/spectral/input_error.h"
#include "metamer/stage/capture_faults.h"
#include "metamer/stage/skin_priority.h"
#include "metamer/stage/wall_intervals.h"
#include "spectrum_like.h"
#include "stage.h"

using namespace nanobind::literals;

// What a capture shows of its own faults, and how sure a wall's solution is.
namespace metamer::python {
namespace {

using stage::CaptureFault;
using stage::CaptureNoise;
using stage::WallCapture;
using stage::WallIntervals;

std::optional<stage::ChartExpectation> expectationOf(const WallCapture& capture, nb::handle reflectances,
                                                     std::pair<int, int> grid) {
  if (reflectances.is_none()) {
    return std::nullopt;
  }
  const spectral::ReflectanceSet set{nameOrFile(reflectances).value_or("reflectances"), reflectancesFrom(reflectances)};
  return stage::expectationOf(capture.patchNames, set, grid.first, grid.second);
}

std::vector<CaptureFault> faults(const WallCapture& capture, nb::handle reflectances, std::pair<int, int> grid,
                                 const nb::object& whitePatch) {
  return stage::captureFaults(capture, expectationOf(capture, reflectances, grid),
                              patchOf(capture, whitePatch, "white_patch"));
}

CaptureNoise noiseFrom(const WallCapture& capture, const nb::object& noise, nb::handle reflectances,
                       std::pair<int, int> grid) {
  if (!noise.is_none()) {
    const Doubles numbers = doubles(noise);
    if (numbers.size() != 1 && numbers.size() != 2) {
      throw nb::value_error("noise: must be a part of each value, or that and a floor in the camera's unit");
    }
    return {numbers.data()[0], numbers.size() == 2 ? numbers.data()[1] : 0.0};
  }
  const auto expectation = expectationOf(capture, reflectances, grid);
  if (!expectation) {
    throw nb::value_error("noise: give it, since too few patches are among the chart's reflectances to estimate it");
  }
  return {
      stage::estimatedNoise(*expectation, {capture.charts[0], capture.charts[1], capture.charts[2], capture.target}),
      0};
}

WallIntervals intervals(const WallCapture& capture, const nb::object& noise, int samples, std::uint64_t seed,
                        nb::handle reflectances, std::pair<int, int> grid, const nb::object& whitePatch,
                        const std::optional<double>& whiteReflectance, const nb::object& xyzFromCamera,
                        const nb::object& heldPatch, const nb::object& patchWeights,
                        const std::optional<double>& largestCondition, const WallCapture* skins, double skinWeight) {
  stage::IntervalOptions options;
  options.noise = noiseFrom(capture, noise, reflectances, grid);
  options.samples = samples;
  options.seed = seed;
  options.choosesBound = !largestCondition;
  options.exposurePatch = patchOf(capture, whitePatch, "white_patch");
  if (whiteReflectance) {
    if (options.exposurePatch < 0) {
      throw nb::value_error("white_reflectance: needs white_patch, the patch that it is of");
    }
    options.whitePatch = options.exposurePatch;
    options.whiteReflectance = *whiteReflectance;
  }
  options.whiteRgb =
      options.exposurePatch < 0 ? capture.environmentWhite : capture.target.col(options.exposurePatch).eval();
  options.xyzFromCamera = matrix3(xyzFromCamera, "xyz_from_camera");
  const stage::WallOptions walls = wallOptionsFrom(
      capture, heldPatch, patchWeights, largestCondition.value_or(stage::kDefaultLargestCondition), skins, skinWeight);
  const nb::gil_scoped_release released;
  return stage::wallIntervals(capture, walls, options);
}

template <typename Binding>
void matrixEnds(Binding& binding, const char* name, stage::Interval<Eigen::Matrix3d> WallIntervals::*ends,
                const char* documentation) {
  binding.def_prop_ro(
      name,
      [ends](const WallIntervals& self) {
        return std::pair(newMatrix((self.*ends).low), newMatrix((self.*ends).high));
      },
      documentation);
}

template <typename Binding>
void numberEnds(Binding& binding, const char* name, stage::Interval<double> WallIntervals::*ends,
                const char* documentation) {
  binding.def_prop_ro(
      name, [ends](const WallIntervals& self) { return std::pair((self.*ends).low, (self.*ends).high); },
      documentation);
}

void bindIntervals(nb::module_& module) {
  nb::class_<WallIntervals> found(module, "WallIntervals",
                                  "95 % intervals of a wall's solution; each is a pair, its lower and upper ends.");
  matrixEnds(found, "M", &WallIntervals::wallFromContent, "");
  matrixEnds(found, "Q", &WallIntervals::correctedFromCamera, "");
  matrixEnds(found, "N", &WallIntervals::frustumFromContent, "With its bound.");
  found.def_prop_ro("environment_drive", [](const WallIntervals& self) {
    return std::pair(newVector(self.environmentDrive.low), newVector(self.environmentDrive.high));
  });
  numberEnds(found, "mean_before", &WallIntervals::meanBefore, "Mean CIEDE2000 of the chart with M alone.");
  numberEnds(found, "mean_after", &WallIntervals::meanAfter, "With M and Q.");
  numberEnds(found, "max_after", &WallIntervals::maxAfter, "The largest, with M and Q.");
  found.def_ro("samples", &WallIntervals::samples)
      .def_ro("largest_condition", &WallIntervals::largestCondition, "N's bound: chosen, or as given.")
      .def_ro("bound_is_chosen", &WallIntervals::boundIsChosen)
      .def_ro("frustum_error", &WallIntervals::frustumError, "|Q [SL] N - 1|, root mean square over the samples.");
}

}  // namespace

void bindConfidence(nb::module_& module) {
  nb::class_<CaptureFault>(module, "CaptureFault", "A mistake that a capture shows.")
      .def_ro("field", &CaptureFault::field, "Of the capture: 'charts.red', 'primaries', 'target'.")
      .def_ro("value", &CaptureFault::value, "The patch, or the numbers; may be empty.")
      .def_ro("remedy", &CaptureFault::remedy, "What is wrong, by how much, and what to do.")
      .def("__str__", [](const CaptureFault& self) {
        return std::string(spectral::InputError("", self.field, self.value, self.remedy).what());
      });
  bindIntervals(module);
  module.def(
      "capture_faults", &faults, "capture"_a, nb::kw_only(), "reflectances"_a.none() = "colorchecker",
      "grid"_a = std::pair(6, 4), "white_patch"_a = nb::none(),
      nb::sig("def capture_faults(capture: WallCapture, *, reflectances: metamer._types.File | "
              "collections.abc.Iterable[metamer._types.SpectrumLike] | None = 'colorchecker', grid: tuple[int, int] = "
              "(6, 4), white_patch: int | str | None = None) -> list[CaptureFault]"),
      "Mistakes that a capture shows by itself: charts used twice, mixed up, mirrored or shifted, channels swapped,\n"
      "wrong names, primaries of another exposure, clipped and veiled patches. None where all is well.\n"
      "`reflectances` and `grid` (columns, rows) are the chart's; None: only what colours alone tell.");
  module.def(
      "wall_intervals", &intervals, "capture"_a, nb::kw_only(), "noise"_a = nb::none(), "samples"_a = 500, "seed"_a = 1,
      "reflectances"_a.none() = "colorchecker", "grid"_a = std::pair(6, 4), "white_patch"_a = nb::none(),
      "white_reflectance"_a = nb::none(), "xyz_from_camera"_a, "held_patch"_a = nb::none(),
      "patch_weights"_a = nb::none(), "largest_condition"_a = nb::none(), "skins"_a.none() = nb::none(),
      "skin_weight"_a = stage::kDefaultSkinWeight,
      nb::sig("def wall_intervals(capture: WallCapture, *, noise: float | tuple[float, float] | None = None, samples: "
              "int = 500, seed: int = 1, reflectances: metamer._types.File | "
              "collections.abc.Iterable[metamer._types.SpectrumLike] | None = 'colorchecker', grid: tuple[int, int] = "
              "(6, 4), white_patch: int | str | None = None, white_reflectance: float | None = None, xyz_from_camera: "
              "numpy.typing.ArrayLike, held_patch: int | str | None = None, patch_weights: numpy.typing.ArrayLike | "
              "None = None, largest_condition: float | None = None, skins: WallCapture | None = None, skin_weight: "
              "float = 6.0) -> WallIntervals"),
      "95 % intervals of what solve() gives, by captures with their noise once more: `noise` is a part of each value,\n"
      "or that and a floor; None: estimated from the chart. `xyz_from_camera` and `white_patch` are for\n"
      "colour differences; with `white_reflectance` the environment's white is that patch of the target over it, and "
      "not\n"
      "captured by itself. Without `largest_condition` N's bound is chosen "
      "from\n"
      "the noise; give solve() the same. The same seed gives the same numbers.");
}

}  // namespace metamer::python
