// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/match_outcome.h"

#include <utility>

#include "metamer/spectral/argument_checks.h"
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

/// A light to match by spectra, for an observer.
struct SpectralTask {
  const MatchRequest& request;
  MatchMethod method;
  const Fixture& fixture;
  spectral::DomainSamples light;
  ObserverCurves curves;
  Materials chart;
  Materials skins;
  Eigen::Matrix3d xyzFromResponse;
  Eigen::Vector3d white;

  MatchSystem system(const Materials& materials) const {
    return systemOf(method, request, fixture, light, curves, materials);
  }

  /// Drives, with each skin of a weight beside the chart's patches.
  EmitterMatch solved(double skinWeight) const {
    const bool hasSkins = skinWeight > 0 && !skins.samples.empty();
    if (!isPerceptual(method, request)) {
      const MatchSystem charted = system(chart);
      return solveMatch(hasSkins ? together(charted, system(skins), skinWeight) : charted, request.limits);
    }
    SeenResponses seen{xyzFromResponse, white / white[1]};
    MatchSystem all = system(chart);
    if (hasSkins) {
      seen.patchWeights = Eigen::VectorXd::Constant(
          all.target.size() / 3 + static_cast<Eigen::Index>(skins.samples.size()), skinWeight);
      seen.patchWeights.head(all.target.size() / 3).setOnes();
      all = together(all, system(skins), 1);
    }
    const auto illuminant = solveMatch(illuminantSystem(fixture.columns, light, curves), request.limits);
    return solvePerceptualMatch(all, seen, {illuminant.drives}, request.limits);
  }

  std::vector<double> differences(const Materials& materials, const Eigen::VectorXd& drives) const {
    return chartDifferences(chartUnder(fixture.columns * drives, curves, materials),
                            chartUnder(light, curves, materials), xyzFromResponse, white);
  }

  MatchSkins skinsOf(const EmitterMatch& match) const {
    MatchSkins result{static_cast<int>(skins.samples.size()),
                      request.skinWeight,
                      skinDifferencesOf(differences(skins, match.drives)),
                      {}};
    // By what is seen each weight takes a second or so: where skin is asked about, it is worth it.
    if (method == MatchMethod::MetamericReflectance && (!isPerceptual(method, request) || request.skinWeight > 0)) {
      for (const double weight : skinTradeOffWeights(request.skinWeight)) {
        const Eigen::VectorXd drives = weight == request.skinWeight ? match.drives : solved(weight).drives;
        result.tradeOffs.push_back(
            {weight, summaryOf(differences(chart, drives)).mean, skinDifferencesOf(differences(skins, drives))});
      }
    }
    return result;
  }
};

void checkSkinWeight(const MatchRequest& request, MatchMethod method, bool hasSpectra) {
  spectral::requireWithin("skin weight", request.skinWeight, 0, kLargestSkinWeight);
  if (request.skinWeight > 0 && method != MatchMethod::MetamericReflectance) {
    throw InputError("--priority", "skin", request.method, "has a meaning with method mrm alone; leave one out");
  }
  if (request.skinWeight > 0 && !hasSpectra) {
    throw InputError("--priority", "skin", "",
                     "needs the emitters' spectra: a chart alone does not tell what skin does");
  }
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
                          const Eigen::Matrix3d& xyzFromResponse, const std::vector<spectral::Spectrum>& skins) {
  checkWeights(request);
  const MatchMethod method = matchMethodFromName(request.method);
  checkSkinWeight(request, method, true);
  const ObserverCurves curves = observer.onDomain();
  const spectral::DomainSamples light = target.onDomain();
  MatchOutcome outcome;
  outcome.observer = observer.name;
  outcome.emitters = fixture.names;
  outcome.models = fixture.models;
  outcome.notes = fixture.notes;
  outcome.xyzFromResponse = xyzFromResponse;
  outcome.white = curves.transpose() * light;
  const SpectralTask task{
      request,         method,       fixture, light, curves, materialsOf(materials), materialsOf(skins),
      xyzFromResponse, outcome.white};
  outcome.match = task.solved(request.skinWeight);
  if (!skins.empty()) {
    outcome.skins = task.skinsOf(outcome.match);
  }
  const spectral::DomainSamples mixed = fixture.columns * outcome.match.drives;
  outcome.patches = task.chart.names;
  outcome.wanted = chartUnder(light, curves, task.chart);
  outcome.made = chartUnder(mixed, curves, task.chart);
  for (Eigen::Index k = 0; k < fixture.columns.cols(); ++k) {
    outcome.emitterCharts.push_back(chartUnder(fixture.columns.col(k), curves, task.chart));
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
  checkSkinWeight(request, method, false);
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
