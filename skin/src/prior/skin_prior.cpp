// SPDX-License-Identifier: Apache-2.0
#include "metamer/skin/skin_prior.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <string>

#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/missing_file_error.h"
#include "metamer/spectral/path_text.h"

namespace metamer::skin {
namespace {

constexpr double kLeastShare = 0.001;
constexpr double kMostShare = 0.999;

/// As many finite numbers as a vector or row has.
template <typename Numbers>
void take(const nlohmann::json& list, Numbers&& numbers, const std::string& where, const char* field) {
  if (!list.is_array() || list.size() != static_cast<std::size_t>(numbers.size())) {
    throw spectral::InputError(where, field, "", "must be a list of " + std::to_string(numbers.size()) + " numbers");
  }
  for (Eigen::Index i = 0; i < numbers.size(); ++i) {
    const nlohmann::json& item = list[static_cast<std::size_t>(i)];
    if (!item.is_number()) {
      throw spectral::InputError(where, field, item.dump(), "must be a number");
    }
    numbers[i] = item.template get<double>();
  }
}

/// Two standard normal numbers from two uniform ones: the standard library's are not the same everywhere.
std::array<double, 2> normalPair(std::mt19937& random) {
  const auto unit = [&] { return (static_cast<double>(random()) + 0.5) / 4294967296.0; };
  const double size = std::sqrt(-2 * std::log(unit()));
  const double turn = 2 * std::numbers::pi * unit();
  return {size * std::cos(turn), size * std::sin(turn)};
}

}  // namespace

SkinPrior SkinPrior::read(const spectral::DataLibrary& library) {
  const std::filesystem::path file = library.skinPriorFile();
  const std::string where = spectral::utf8(file);
  std::ifstream stream(file);
  if (!stream) {
    throw spectral::MissingFileError(where, "skin prior", "", "cannot be read; use the data folder of this release");
  }
  const nlohmann::json document = nlohmann::json::parse(stream, nullptr, false);
  if (!document.is_object()) {
    throw spectral::InputError(where, "skin prior", "", "is no JSON object; use the data folder of this release");
  }
  const auto member = [&](const nlohmann::json& parent, const char* key) {
    return parent.is_object() ? parent.value(key, nlohmann::json()) : nlohmann::json();
  };
  SkinPrior prior;
  take(member(document, "mean"), prior.mean, where, "mean");
  take(member(document, "standard_deviation"), prior.standardDeviation, where, "standard_deviation");
  take(member(member(document, "relative_misfit"), "measured_over_model_minus_1"), prior.misfit, where,
       "measured_over_model_minus_1");
  const nlohmann::json rows = member(document, "correlation");
  if (!rows.is_array() || rows.size() != 5) {
    throw spectral::InputError(where, "correlation", "", "must be a list of 5 lists");
  }
  for (Eigen::Index i = 0; i < 5; ++i) {
    take(rows[static_cast<std::size_t>(i)], prior.correlation.row(i), where, "correlation");
  }
  if (!(prior.standardDeviation.minCoeff() > 0) || prior.covariance().llt().info() != Eigen::Success) {
    throw spectral::InputError(where, "correlation", "",
                               "is none of a distribution; use the data folder of this release");
  }
  return prior;
}

Eigen::Matrix<double, 5, 5> SkinPrior::covariance() const {
  return standardDeviation.asDiagonal() * correlation * standardDeviation.asDiagonal();
}

std::vector<SkinParameters> sampleSkins(const SkinPrior& prior, int count, std::uint32_t seed) {
  spectral::requireWithin("count", count, 0, 1e6);
  const Eigen::Matrix<double, 5, 5> root = prior.covariance().llt().matrixL();
  std::mt19937 random(seed);
  std::vector<SkinParameters> skins;
  skins.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    // Six, so that a skin begins with a fresh pair.
    std::array<std::array<double, 2>, 3> pairs{};
    for (std::array<double, 2>& pair : pairs) {
      pair = normalPair(random);
    }
    SkinCoordinates normal;
    normal << pairs[0][0], pairs[0][1], pairs[1][0], pairs[1][1], pairs[2][0];
    SkinParameters skin = skinOf(prior.mean + root * normal);
    for (double* const share : {&skin.melanin, &skin.blood, &skin.eumelanin, &skin.deoxyhaemoglobin}) {
      *share = std::clamp(*share, kLeastShare, kMostShare);
    }
    skins.push_back(skin);
  }
  return skins;
}

SkinSpectrum repaired(const SkinSpectrum& albedo, const SkinPrior& prior) {
  return (albedo.array() * (1 + prior.misfit.array())).max(0);
}

std::vector<spectral::Spectrum> virtualSkins(const spectral::DataLibrary& library, int count, std::uint32_t seed) {
  const SkinPrior prior = SkinPrior::read(library);
  const SkinModel model(library);
  std::vector<spectral::Spectrum> result;
  for (const SkinParameters& skin : sampleSkins(prior, count, seed)) {
    const SkinSpectrum albedo = repaired(model.albedo(skin), prior);
    result.emplace_back("skin " + std::to_string(result.size()), spectral::SpectralQuantity::Reflectance,
                        skinWavelengths(), std::vector<double>(albedo.begin(), albedo.end()));
  }
  return result;
}

}  // namespace metamer::skin
