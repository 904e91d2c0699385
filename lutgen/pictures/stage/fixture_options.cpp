// SPDX-License-Identifier: Apache-2.0
#include "stage/fixture_options.h"

#include "metamer/sip/pipeline.h"
#include "metamer/spectral/input_error.h"

namespace metamer::lutgen {
namespace {

constexpr const char* kTrainingSet = "rawtoaces 190";
constexpr const char* kStandardObserver = "CIE 1931 2";

Eigen::VectorXd spread(const std::vector<double>& values, std::size_t count, const char* flag) {
  if (values.size() == 1) {
    return Eigen::VectorXd::Constant(static_cast<Eigen::Index>(count), values.front());
  }
  if (!values.empty() && values.size() != count) {
    throw spectral::InputError(flag, "values", std::to_string(values.size()),
                               "must be one, or one an emitter (" + std::to_string(count) + ")");
  }
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace

void addFixtureLimits(CLI::App& command, FixtureLimits& limits) {
  command.add_option("--limits", limits.largest, "Largest drive: one for all, or one an emitter")->expected(1, 64);
  command.add_option("--power", limits.power, "Power at a drive of 1: one for all, or one an emitter")->expected(1, 64);
  command.add_option("--power-budget", limits.budget, "Largest sum of power times drive; needs --power")
      ->check(CLI::PositiveNumber)
      ->needs("--power");
}

stage::DriveLimits limitsOf(const FixtureLimits& limits, std::size_t emitterCount) {
  stage::DriveLimits result;
  result.upper = spread(limits.largest, emitterCount, "--limits");
  if (limits.budget > 0) {
    result.power = spread(limits.power, emitterCount, "--power");
    result.powerBudget = limits.budget;
  }
  return result;
}

Eigen::Matrix3d xyzFromResponseUnder(const spectral::Spectrum& light, const spectral::Observer& observer,
                                     const spectral::DataLibrary& library) {
  std::vector<spectral::DomainSamples> training;
  for (const auto& sample : library.reflectances(kTrainingSet).samples) {
    training.push_back(sample.onDomain());
  }
  return sip::prepare({light, {}, observer}, training, library.observer(kStandardObserver)).xyzFromResponse;
}

}  // namespace metamer::lutgen
