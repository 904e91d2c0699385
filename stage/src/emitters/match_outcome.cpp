// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/match_outcome.h"

#include <utility>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/spectral_similarity_index.h"
#include "metamer/stage/chart_difference.h"
#include "metamer/stage/patch_names.h"

namespace metamer::stage {
namespace {

using spectral::InputError;

/// A colour that is matched but for this is matched.
constexpr double kMatched = 1e-9;

struct Materials {
  std::vector<std::string> names;
  std::vector<spectral::DomainSamples> samples;
};

Materials materialsOf(const std::vector<spectral::Spectrum>& set) {
  Materials materials;
  for (const spectral::Spectrum& sample : set) {
    materials.names.push_back(sample.name());
    materials.samples.push_back(sample.onDomain());
  }
  return materials;
}

Eigen::Matrix3Xd chartUnder(const spectral::DomainSamples& light, const ObserverCurves& curves,
                            const Materials& materials) {
  Eigen::Matrix3Xd chart(3, static_cast<Eigen::Index>(materials.samples.size()));
  for (std::size_t i = 0; i < materials.samples.size(); ++i) {
    chart.col(static_cast<Eigen::Index>(i)) = curves.transpose() * materials.samples[i].cwiseProduct(light);
  }
  return chart;
}

void checkWeights(const MatchRequest& request) {
  if (request.weights != "absolute" && request.weights != "relative" && request.weights != "perceptual") {
    throw InputError(request.where, "weights", request.weights, "must be absolute, relative or perceptual");
  }
}

MatchWeights weightsOf(const MatchRequest& request) {
  return request.weights == "relative" ? MatchWeights::Relative : MatchWeights::Absolute;
}

bool isPerceptual(MatchMethod method, const MatchRequest& request) {
  return method == MatchMethod::MetamericReflectance && request.weights == "perceptual";
}

MatchSystem systemOf(MatchMethod method, const MatchRequest& request, const Fixture& fixture,
                     const spectral::DomainSamples& target, const ObserverCurves& curves, const Materials& materials) {
  switch (method) {
    case MatchMethod::Spectral:
      return spectralSystem(fixture.columns, target);
    case MatchMethod::MetamericIlluminant:
      return illuminantSystem(fixture.columns, target, curves);
    case MatchMethod::MetamericReflectance:
      break;
  }
  return reflectanceSystem(fixture.columns, target, curves, materials.samples, weightsOf(request));
}

}  // namespace

std::vector<double> differencesOf(const MatchOutcome& outcome) {
  return chartDifferences(outcome.made, outcome.wanted, outcome.xyzFromResponse, outcome.white);
}

void addReachNotes(MatchOutcome& outcome) {
  for (const int dead : outcome.match.deadEmitters) {
    outcome.notes.push_back("emitter '" + outcome.emitters[static_cast<std::size_t>(dead)] +
                            "' gives no light to what is matched; its drive is 0");
  }
  if (matchMethodFromName(outcome.method) == MatchMethod::MetamericIlluminant &&
      outcome.match.relativeResidual > kMatched) {
    outcome.notes.push_back("the target's colour is out of the emitters' reach: no mixture within the limits has it");
  }
}

MatchOutcome matchSpectra(const MatchRequest& request, const Fixture& fixture, const spectral::Spectrum& target,
                          const spectral::Observer& observer, const std::vector<spectral::Spectrum>& materials,
                          const Eigen::Matrix3d& xyzFromResponse) {
  checkWeights(request);
  const Materials charted = materialsOf(materials);
  const ObserverCurves curves = observer.onDomain();
  const spectral::DomainSamples light = target.onDomain();
  MatchOutcome outcome;
  outcome.observer = observer.name;
  outcome.emitters = fixture.names;
  outcome.models = fixture.models;
  outcome.notes = fixture.notes;
  outcome.xyzFromResponse = xyzFromResponse;
  outcome.white = curves.transpose() * light;
  const MatchMethod method = matchMethodFromName(request.method);
  const MatchSystem system = systemOf(method, request, fixture, light, curves, charted);
  if (isPerceptual(method, request)) {
    const auto illuminant = solveMatch(illuminantSystem(fixture.columns, light, curves), request.limits);
    const Eigen::Vector3d white = outcome.white / outcome.white[1];
    outcome.match = solvePerceptualMatch(system, {outcome.xyzFromResponse, white}, {illuminant.drives}, request.limits);
  } else {
    outcome.match = solveMatch(system, request.limits);
  }
  const spectral::DomainSamples mixed = fixture.columns * outcome.match.drives;
  outcome.patches = charted.names;
  outcome.wanted = chartUnder(light, curves, charted);
  outcome.made = chartUnder(mixed, curves, charted);
  for (Eigen::Index k = 0; k < fixture.columns.cols(); ++k) {
    outcome.emitterCharts.push_back(chartUnder(fixture.columns.col(k), curves, charted));
  }
  if (mixed.maxCoeff() > 0) {
    outcome.spectralSimilarity = spectral::spectralSimilarityIndex(mixedLight(mixed), target);
  }
  return outcome;
}

MatchOutcome matchCharts(const MatchRequest& request, std::vector<ChartTable> emitterCharts, const ChartTable& target,
                         const Eigen::Matrix3d& xyzFromCamera) {
  checkWeights(request);
  const MatchMethod method = matchMethodFromName(request.method);
  if (method == MatchMethod::Spectral) {
    throw InputError(request.where, "method", request.method, "needs spectra; charts do for mim and mrm");
  }
  MatchOutcome outcome;
  emitterCharts.push_back(target);
  auto aligned = alignCharts(emitterCharts, std::nullopt);
  if (aligned.names.empty()) {
    throw InputError(request.where, "charts", "", "no patch is in all charts with values that can be used");
  }
  outcome.excluded = aligned.excluded;
  outcome.patches = aligned.names;
  outcome.wanted = aligned.charts.back();
  aligned.charts.pop_back();
  Eigen::Index brightest = 0;
  outcome.wanted.row(1).maxCoeff(&brightest);
  const int white = patchNamed(aligned.names, "white");
  const Eigen::Index whitePatch = white >= 0 ? white : brightest;
  outcome.xyzFromResponse = xyzFromCamera;
  outcome.white = outcome.wanted.col(whitePatch);
  const auto illuminantMatch = [&] {
    std::vector<Eigen::Matrix3Xd> whites;
    for (const Eigen::Matrix3Xd& chart : aligned.charts) {
      whites.emplace_back(chart.col(whitePatch));
    }
    return solveMatch(chartSystem(whites, outcome.wanted.col(whitePatch)), request.limits);
  };
  if (method == MatchMethod::MetamericIlluminant) {
    outcome.match = illuminantMatch();
  } else {
    const auto system = chartSystem(aligned.charts, outcome.wanted, weightsOf(request));
    outcome.match = isPerceptual(method, request)
                        ? solvePerceptualMatch(system, {outcome.xyzFromResponse, outcome.white},
                                               {illuminantMatch().drives}, request.limits)
                        : solveMatch(system, request.limits);
  }
  outcome.made = Eigen::Matrix3Xd::Zero(3, outcome.wanted.cols());
  for (std::size_t k = 0; k < aligned.charts.size(); ++k) {
    outcome.made += outcome.match.drives[static_cast<Eigen::Index>(k)] * aligned.charts[k];
  }
  outcome.emitterCharts = std::move(aligned.charts);
  return outcome;
}

}  // namespace metamer::stage
