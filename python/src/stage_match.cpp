// SPDX-License-Identifier: Apache-2.0
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <string>
#include <tuple>
#include <vector>

#include "arrays.h"
#include "bindings.h"
#include "metamer/sip/recipe.h"
#include "metamer/stage/emitter_match.h"
#include "metamer/stage/emitter_model.h"
#include "spectrum_like.h"
#include "stage.h"

using namespace nanobind::literals;

namespace metamer::python {
namespace {

using spectral::DomainSamples;
using spectral::SpectralQuantity;
using stage::EmitterMatch;

stage::EmitterColumns emitterColumns(const nb::sequence& emitters) {
  std::vector<DomainSamples> columns;
  for (const nb::handle emitter : emitters) {
    if (const auto name = nameOrFile(emitter)) {
      for (const stage::Emitter& found : stage::emittersFrom(*name, libraryOr(nullptr))) {
        columns.push_back(found.spectrum.onDomain());
      }
    } else {
      columns.push_back(spectrumFrom(emitter, SpectralQuantity::SpectralPowerDistribution).onDomain());
    }
  }
  stage::EmitterColumns matrix(spectral::kDomainSize, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    matrix.col(static_cast<Eigen::Index>(i)) = columns[i];
  }
  return matrix;
}

std::vector<DomainSamples> materialsOf(nb::handle reflectances) {
  std::vector<DomainSamples> samples;
  for (const spectral::Spectrum& sample : reflectancesFrom(reflectances)) {
    samples.push_back(sample.onDomain());
  }
  return samples;
}

/// What an observer's responses look like under a light; a camera without a matrix has its own solved, as a recipe's.
Eigen::Matrix3d xyzFromResponse(const spectral::Observer& observer, const spectral::Spectrum& light) {
  if (observer.xyzFromResponse) {
    return *observer.xyzFromResponse;
  }
  sip::Recipe recipe;
  recipe.input.illuminant = recipe.output.illuminant = "E";
  const sip::TransformSpec spec = sip::resolve(recipe, libraryOr(nullptr));
  return sip::prepare({light, {}, observer}, spec.training, spec.standardObserver).xyzFromResponse;
}

enum class Weights { Absolute, Relative, Perceptual };

Weights weightsNamed(const std::string& name) {
  if (name == "absolute") {
    return Weights::Absolute;
  }
  if (name == "relative") {
    return Weights::Relative;
  }
  if (name == "perceptual") {
    return Weights::Perceptual;
  }
  throw nb::value_error(("weights '" + name + "': must be absolute, relative or perceptual").c_str());
}

stage::MatchWeights linear(Weights weights) {
  return weights == Weights::Relative ? stage::MatchWeights::Relative : stage::MatchWeights::Absolute;
}

EmitterMatch match(nb::handle target, const nb::sequence& emitters, const std::string& methodName, nb::handle observed,
                   nb::handle reflectances, const std::string& weightsName, const nb::object& upper,
                   const nb::object& power, const nb::object& budget) {
  const stage::MatchMethod method = stage::matchMethodFromName(methodName);
  const Weights weights = weightsNamed(weightsName);
  const stage::EmitterColumns columns = emitterColumns(emitters);
  const stage::DriveLimits limits = limitsFrom(upper, power, budget, columns.cols());
  const spectral::Spectrum light = lightFrom(target);
  const DomainSamples wanted = light.onDomain();
  if (method == stage::MatchMethod::Spectral) {
    return stage::solveMatch(stage::spectralSystem(columns, wanted), limits);
  }
  const spectral::Observer observer = namedObserverFrom(observed);
  const stage::ObserverCurves curves = observer.onDomain();
  if (method == stage::MatchMethod::MetamericIlluminant) {
    return stage::solveMatch(stage::illuminantSystem(columns, wanted, curves), limits);
  }
  const auto system = stage::reflectanceSystem(columns, wanted, curves, materialsOf(reflectances), linear(weights));
  if (weights != Weights::Perceptual) {
    return stage::solveMatch(system, limits);
  }
  const Eigen::Vector3d white = curves.transpose() * wanted;
  const auto start = stage::solveMatch(stage::illuminantSystem(columns, wanted, curves), limits);
  return stage::solvePerceptualMatch(system, {xyzFromResponse(observer, light), white / white[1]}, {start.drives},
                                     limits);
}

EmitterMatch matchCharts(const nb::sequence& charts, nb::handle target, const std::string& weights,
                         const nb::object& upper, const nb::object& power, const nb::object& budget) {
  const std::vector<Eigen::Matrix3Xd> lit = chartsOf(charts);
  const Eigen::Matrix3Xd wanted = patchColumns(target, "target");
  if (!lit.empty() && lit[0].cols() != wanted.cols()) {
    throw nb::value_error("charts: must have the target's patches");
  }
  if (weightsNamed(weights) == Weights::Perceptual) {
    throw nb::value_error("weights 'perceptual': needs spectra; charts take absolute or relative");
  }
  return stage::solveMatch(stage::chartSystem(lit, wanted, linear(weightsNamed(weights))),
                           limitsFrom(upper, power, budget, static_cast<Eigen::Index>(lit.size())));
}

std::tuple<NumpyDoubles, double, int> leastSquares(nb::handle matrix, nb::handle target, const nb::object& upper,
                                                   const nb::object& power, const nb::object& budget) {
  const Doubles rows = doubles(matrix);
  const Doubles wanted = doubles(target);
  if (rows.ndim() != 2 || wanted.ndim() != 1 || rows.shape(0) != wanted.shape(0) || rows.size() == 0) {
    throw nb::value_error("matrix and target: must have as many rows, at least one, and a column a drive");
  }
  const auto count = static_cast<Eigen::Index>(rows.shape(1));
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto height = static_cast<Eigen::Index>(rows.shape(0));
  const auto solution = stage::nonNegativeLeastSquares(Eigen::Map<const RowMajor>(rows.data(), height, count),
                                                       Eigen::Map<const Eigen::VectorXd>(wanted.data(), height),
                                                       limitsFrom(upper, power, budget, count));
  return {newVector(solution.x), solution.residualNorm, solution.rank};
}

const std::string kLimits =
    "upper: numpy.typing.ArrayLike | None = None, power: numpy.typing.ArrayLike | None = None, power_budget: float | "
    "None = None";

}  // namespace

void bindMatch(nb::module_& module) {
  nb::class_<EmitterMatch>(module, "EmitterMatch", "Drives of several emitters.")
      .def_prop_ro("drives", [](const EmitterMatch& self) { return newVector(self.drives); })
      .def_ro("residual", &EmitterMatch::residualNorm)
      .def_ro("relative_residual", &EmitterMatch::relativeResidual, "Over the target's own size.")
      .def_ro("rank", &EmitterMatch::rank, "Below the number of emitters the drives are the shortest of several.")
      .def_ro("condition", &EmitterMatch::condition)
      .def_ro("dead_emitters", &EmitterMatch::deadEmitters, "That add nothing to what is matched.");
  module.def("match_emitters", &match, "target"_a, "emitters"_a, nb::kw_only(), "method"_a = "mrm",
             "observer"_a = "CIE 1931 2", "reflectances"_a = "colorchecker", "weights"_a = "absolute",
             "upper"_a = nb::none(), "power"_a = nb::none(), "power_budget"_a = nb::none(),
             nb::sig(("def match_emitters(target: metamer._types.NamedSpectrum, emitters: "
                      "collections.abc.Sequence[metamer._types.NamedSpectrum], *, method: str = 'mrm', observer: "
                      "metamer._types.NamedObserver = 'CIE 1931 2', reflectances: metamer._types.File | "
                      "collections.abc.Iterable[metamer._types.SpectrumLike] = 'colorchecker', weights: str = "
                      "'absolute', " +
                      kLimits + ") -> EmitterMatch")
                         .c_str()),
             "Drives that reproduce a light. Methods: sim, its spectrum; mim, its colour; mrm, materials in it, by\n"
             "weights absolute, relative or perceptual. A text may also be led:PEAK:WIDTH or a file of several.");
  module.def("match_charts", &matchCharts, "charts"_a, "target"_a, nb::kw_only(), "weights"_a = "absolute",
             "upper"_a = nb::none(), "power"_a = nb::none(), "power_budget"_a = nb::none(),
             nb::sig(("def match_charts(charts: collections.abc.Sequence[numpy.typing.ArrayLike], target: "
                      "numpy.typing.ArrayLike, *, weights: str = 'absolute', " +
                      kLimits + ") -> EmitterMatch")
                         .c_str()),
             "The same from a chart's pictures alone, a row a patch: under each emitter, and in the target light.");
  module.def(
      "non_negative_least_squares", &leastSquares, "matrix"_a, "target"_a, nb::kw_only(), "upper"_a = nb::none(),
      "power"_a = nb::none(), "power_budget"_a = nb::none(),
      nb::sig(("def non_negative_least_squares(matrix: numpy.typing.ArrayLike, target: numpy.typing.ArrayLike, "
               "*, " +
               kLimits + ") -> tuple[numpy.typing.NDArray[numpy.float64], float, int]")
                  .c_str()),
      "The shortest x >= 0 within the limits that minimises |matrix x - target|; the residual's norm; the rank.");
}

}  // namespace metamer::python
