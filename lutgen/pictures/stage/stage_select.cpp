// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iostream>
#include <memory>

#include "library.h"
#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/naming_file.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/spectral/text.h"
#include "metamer/stage/chart_difference.h"
#include "metamer/stage/emitter_selection.h"
#include "metamer/stage/skin_priority.h"
#include "progress.h"
#include "stage/fixture_options.h"
#include "stage/skin_report.h"
#include "stage/stage_commands.h"
#include "stage/stage_json.h"

namespace metamer::lutgen {
namespace {

using spectral::InputError;

struct SelectOptions {
  std::vector<std::string> targets;
  std::vector<std::string> bounces;
  std::vector<std::string> emitters;
  std::vector<std::string> observers = {"CIE 1931 2"};
  std::vector<std::string> kept;
  std::string reflectances = "colorchecker";
  std::string method = "mrm";
  std::string priority;
  int most = 0;
  bool progress = false;
  std::string output;
};

/// A light to reproduce, direct or bounced.
struct Target {
  std::string name;
  spectral::Spectrum direct;
  spectral::DomainSamples power;
};

/// Where a word such as "grass" stands in the tables, and what to do where it does not.
std::string remedyFor(const std::string& word, const spectral::DataLibrary& library) {
  constexpr int kMostNames = 5;
  std::string found;
  int count = 0;
  for (const std::string& set : library.reflectanceSetNames()) {
    for (const spectral::Spectrum& sample : library.reflectances(set).samples) {
      const bool isLike = spectral::lowerCase(sample.name()).find(spectral::lowerCase(word)) != std::string::npos;
      if (isLike && ++count <= kMostNames) {
        found += (found.empty() ? "; did you mean '" : "', '") + set + ":" + sample.name();
      }
    }
  }
  return found.empty() ? "is in none of the measured tables; give a file with its reflectance (CSV: wavelength_nm,name)"
                       : "is no set, and no file; write SET:PATCH" + found + "'?";
}

/// "SET:PATCH", or a file with one reflectance.
spectral::Spectrum reflectanceNamed(const std::string& text, const spectral::DataLibrary& library) {
  const auto sets = library.reflectanceSetNames();
  const auto isSet = [&](const std::string& name) {
    return std::any_of(sets.begin(), sets.end(),
                       [&](const std::string& set) { return spectral::lowerCase(set) == spectral::lowerCase(name); });
  };
  const std::size_t colon = text.rfind(':');
  if (colon != std::string::npos && isSet(text.substr(0, colon))) {
    const auto set = library.reflectances(text.substr(0, colon));
    const std::string patch = text.substr(colon + 1);
    for (const spectral::Spectrum& sample : set.samples) {
      if (spectral::lowerCase(sample.name()) == spectral::lowerCase(patch)) {
        return sample;
      }
    }
    throw InputError("--bounce", "patch", patch, "is not in the set '" + set.name + "'; " + remedyFor(patch, library));
  }
  const bool isWord = text.find_first_of("/\\.:") == std::string::npos;
  if (isWord && !isSet(text)) {
    throw InputError("--bounce", "reflectance", text, remedyFor(text, library));
  }
  auto set = library.reflectances(text);
  if (set.samples.size() != 1) {
    throw InputError("--bounce", "reflectance", text,
                     "holds " + std::to_string(set.samples.size()) + "; write SET:PATCH, or a file with one");
  }
  return set.samples.front();
}

std::vector<Target> targetsOf(const SelectOptions& options, const spectral::DataLibrary& library) {
  std::vector<Target> targets;
  for (const std::string& name : options.targets) {
    const spectral::Spectrum direct = library.illuminant(name);
    targets.push_back({name, direct, direct.onDomain()});
    for (const std::string& bounce : options.bounces) {
      const spectral::Spectrum off = reflectanceNamed(bounce, library);
      targets.push_back({name + " off " + off.name(), direct, direct.onDomain().cwiseProduct(off.onDomain())});
    }
  }
  return targets;
}

std::vector<int> keptOf(const SelectOptions& options, const stage::Fixture& fixture) {
  std::vector<int> kept;
  for (const std::string& name : options.kept) {
    const auto found = std::find(fixture.names.begin(), fixture.names.end(), name);
    if (found == fixture.names.end()) {
      throw InputError("--keep", "emitter", name, "is not among the emitters, which are named as in the report");
    }
    kept.push_back(static_cast<int>(found - fixture.names.begin()));
  }
  return kept;
}

/// A case with what its colour differences need.
struct Case {
  stage::SelectionCase selection;
  const Target* target;
  stage::ObserverCurves curves;
  Eigen::Matrix3d xyzFromResponse;
};

std::vector<double> differencesOf(const Case& one, const stage::Fixture& fixture, const stage::EmitterChoice& choice,
                                  const std::vector<spectral::DomainSamples>& materials) {
  Eigen::MatrixXd matrix(one.selection.system.matrix.rows(), static_cast<Eigen::Index>(choice.emitters.size()));
  for (std::size_t k = 0; k < choice.emitters.size(); ++k) {
    matrix.col(static_cast<Eigen::Index>(k)) = one.selection.system.matrix.col(choice.emitters[k]);
  }
  const Eigen::VectorXd drives = stage::nonNegativeLeastSquares(matrix, one.selection.system.target).x;
  spectral::DomainSamples mixed = spectral::DomainSamples::Zero();
  for (std::size_t k = 0; k < choice.emitters.size(); ++k) {
    mixed += drives[static_cast<Eigen::Index>(k)] * fixture.columns.col(choice.emitters[k]);
  }
  Eigen::Matrix3Xd made(3, static_cast<Eigen::Index>(materials.size()));
  Eigen::Matrix3Xd wanted(3, made.cols());
  for (std::size_t i = 0; i < materials.size(); ++i) {
    made.col(static_cast<Eigen::Index>(i)) = one.curves.transpose() * materials[i].cwiseProduct(mixed);
    wanted.col(static_cast<Eigen::Index>(i)) = one.curves.transpose() * materials[i].cwiseProduct(one.target->power);
  }
  return stage::chartDifferences(made, wanted, one.xyzFromResponse, one.curves.transpose() * one.target->power);
}

std::vector<spectral::DomainSamples> samplesOf(const std::vector<spectral::Spectrum>& spectra) {
  std::vector<spectral::DomainSamples> samples;
  samples.reserve(spectra.size());
  for (const spectral::Spectrum& one : spectra) {
    samples.push_back(one.onDomain());
  }
  return samples;
}

void select(const SelectOptions& options) {
  spectral::requireWritable(spectral::pathOf(options.output));
  const auto library = openLibrary();
  const stage::Fixture fixture = stage::readFixture(options.emitters, library);
  const std::vector<Target> targets = targetsOf(options, library);
  const auto materials = samplesOf(library.reflectances(options.reflectances).samples);
  const auto skins = samplesOf(stage::virtualSkins(library));
  const stage::MatchMethod method = stage::matchMethodFromName(options.method);
  const double skinWeight = options.priority.empty() ? 0 : stage::skinWeightFrom(options.priority);
  if (skinWeight > 0 && method != stage::MatchMethod::MetamericReflectance) {
    throw InputError("--priority", "skin", options.method, "has a meaning with method mrm alone; leave one out");
  }
  std::vector<Case> cases;
  for (const Target& target : targets) {
    for (const std::string& name : options.observers) {
      const spectral::Observer observer = library.observer(name);
      const stage::ObserverCurves curves = observer.onDomain();
      const Eigen::Matrix3d xyzFromResponse =
          spectral::namingFile(target.name, [&] { return xyzFromResponseUnder(target.direct, observer, library); });
      stage::MatchSystem system;
      if (method == stage::MatchMethod::Spectral) {
        system = stage::spectralSystem(fixture.columns, target.power);
      } else if (method == stage::MatchMethod::MetamericIlluminant) {
        system = stage::illuminantSystem(fixture.columns, target.power, curves);
      } else {
        system = stage::reflectanceSystem(fixture.columns, target.power, curves, materials);
        if (skinWeight > 0) {
          system = stage::together(
              system, stage::condensed(stage::reflectanceSystem(fixture.columns, target.power, curves, skins)),
              skinWeight);
        }
      }
      cases.push_back({{target.name + ", " + observer.name, std::move(system)}, &target, curves, xyzFromResponse});
    }
  }
  std::vector<stage::SelectionCase> selectionCases;
  selectionCases.reserve(cases.size());
  for (const Case& one : cases) {
    selectionCases.push_back(one.selection);
  }
  std::vector<stage::EmitterChoice> curve;
  {
    Progress progress("subsets", options.progress);
    curve = stage::selectEmitters(selectionCases, keptOf(options, fixture), options.most,
                                  [&progress](double share) { progress.show(share); });
    progress.show(1);
  }

  Json json;
  json["method"] = options.method;
  json["emitters"] = fixture.names;
  json["models"] = fixture.models;
  json["cases"] = Json::array();
  for (const Case& one : cases) {
    json["cases"].push_back(one.selection.name);
  }
  json["best"] = Json::array();
  for (const stage::EmitterChoice& choice : curve) {
    stage::DifferenceSummary overall;
    std::vector<double> ofSkin;
    Json perCase = Json::array();
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const auto summary = stage::summaryOf(differencesOf(cases[i], fixture, choice, materials));
      overall.mean += summary.mean / static_cast<double>(cases.size());
      overall.max = std::max(overall.max, summary.max);
      const auto skin = differencesOf(cases[i], fixture, choice, skins);
      ofSkin.insert(ofSkin.end(), skin.begin(), skin.end());
      perCase.push_back({{"residual", choice.caseResiduals[i]},
                         {"dE_mean", summary.mean},
                         {"dE_max", summary.max},
                         {"skin_dE", toJson(stage::skinDifferencesOf(skin))}});
    }
    Json names = Json::array();
    std::string listed;
    for (const int emitter : choice.emitters) {
      names.push_back(fixture.names[static_cast<std::size_t>(emitter)]);
      listed += (listed.empty() ? "" : ", ") + fixture.names[static_cast<std::size_t>(emitter)];
    }
    const stage::SkinDifferences skin = stage::skinDifferencesOf(ofSkin);
    json["best"].push_back({{"count", choice.emitters.size()},
                            {"emitters", names},
                            {"indices", choice.emitters},
                            {"error", choice.error},
                            {"dE", {{"mean", overall.mean}, {"max", overall.max}}},
                            {"skin_dE", toJson(skin)},
                            {"cases", perCase}});
    std::cout << spectral::formatted("%2zu  error %.5f  CIEDE2000 mean %5.2f max %6.2f  skin %5.2f  %s\n",
                                     choice.emitters.size(), choice.error, overall.mean, overall.max, skin.mean,
                                     listed.c_str());
  }
  json["virtual_skin"] = {{"count", skins.size()}, {"weight", skinWeight}};
  json["notes"] = fixture.notes;
  writeJson(spectral::pathOf(options.output), json);
}

}  // namespace

void addStageSelect(CLI::App& stage) {
  CLI::App* command = stage.add_subcommand("select", "The best few of many emitters, by trying every subset");
  const auto options = std::make_shared<SelectOptions>();
  command->add_option("--targets", options->targets, "Lights to reproduce: NAME or FILE")->required()->expected(1, 256);
  command
      ->add_option("--bounce", options->bounces,
                   "Reflectances off which each light is reproduced too, such as grass: SET:PATCH or FILE")
      ->expected(1, 64);
  command->add_option("--emitters", options->emitters, "As of stage match; 16 at most")->required()->expected(1, 16);
  command->add_option("--observers", options->observers, "Eyes and cameras: NAME or FILE; CIE 1931 2 by default")
      ->expected(1, 64);
  command->add_option("--reflectances", options->reflectances, "Materials: SET or FILE; colorchecker by default");
  command->add_option("--method", options->method, "sim, mim or mrm, as of stage match; mrm by default")
      ->check(CLI::IsMember({"sim", "mim", "mrm"}, CLI::ignore_case));
  addPriority(*command, options->priority);
  command->add_option("--keep", options->kept, "Emitters that every choice holds, by name")->expected(1, 16);
  command->add_option("--most", options->most, "Largest number of emitters; all by default")->check(CLI::Range(1, 16));
  command->add_flag("--progress", options->progress, "Show progress even where stderr is no terminal");
  command->add_option("--json", options->output, "JSON to write: the best of each number")->required();
  command->callback([options] { select(*options); });
}

}  // namespace metamer::lutgen
