// SPDX-License-Identifier: Apache-2.0
#include "stage/fixture_options.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "metamer/sip/pipeline.h"
#include "metamer/spectral/input_error.h"
#include "positive_number.h"

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

void addPriority(CLI::App& command, std::string& priority) {
  command.add_option("--priority", priority,
                     "What counts beside the chart: skin[:WEIGHT], 200 virtual skins, each of that weight (4) beside a "
                     "patch's 1; needs spectra");
}

void addFixtureLimits(CLI::App& command, FixtureLimits& limits) {
  command.add_option("--limits", limits.largest, "Largest drive: one for all, or one an emitter")->expected(1, 64);
  command.add_option("--power", limits.power, "Power at a drive of 1: one for all, or one an emitter")->expected(1, 64);
  command.add_option("--power-budget", limits.budget, "Largest sum of power times drive; needs --power")
      ->check(positiveNumber())
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

spectral::Spectrum filteredLight(const spectral::Spectrum& light, const std::string& text,
                                 const spectral::DataLibrary& library) {
  std::string name = text;
  double density = 1;
  const std::size_t colon = text.rfind(':');
  if (colon != std::string::npos && colon > 0) {
    const char* end = text.data() + text.size();
    const auto parsed = std::from_chars(text.data() + colon + 1, end, density);
    if (parsed.ec == std::errc() && parsed.ptr == end) {
      if (!std::isfinite(density) || density < 0) {
        throw spectral::InputError("--filters", "density", text,
                                   "must be 0 or more, and finite; 1 is the filter as it is");
      }
      name = text.substr(0, colon);
    } else {
      density = 1;
    }
  }
  const spectral::Spectrum filter = library.filter(name);
  // Every knot of either, and each nanometre: the product of straight lines is close to straight between them.
  std::vector<double> knots = light.wavelengthsNm();
  const double first = knots.front();
  const double last = knots.back();
  for (int nm = spectral::kDomainStartNm; nm <= spectral::kDomainEndNm; ++nm) {
    knots.push_back(nm);
  }
  knots.insert(knots.end(), filter.wavelengthsNm().begin(), filter.wavelengthsNm().end());
  std::sort(knots.begin(), knots.end());
  knots.erase(std::unique(knots.begin(), knots.end()), knots.end());
  std::vector<double> wavelengthsNm;
  std::vector<double> values;
  for (const double nm : knots) {
    if (nm >= first && nm <= last) {
      wavelengthsNm.push_back(nm);
      values.push_back(light.at(nm) * std::pow(std::max(0.0, filter.at(nm)), density));
    }
  }
  spectral::Spectrum product(light.name() + " + " + text, light.quantity(), wavelengthsNm, values);
  return light.isOfFormula() ? product.ofFormula() : product;
}

std::string samplesCheck(const std::string& text) {
  return text == "0" ? std::string() : CLI::Range(20, 100'000)(text);
}

}  // namespace metamer::lutgen
