// SPDX-License-Identifier: Apache-2.0
#include "files/data_manifest.h"

#include <Eigen/LU>
#include <cmath>

#include "files/json_text.h"
#include "files/sampled_rows.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/text.h"

namespace metamer::spectral {
namespace {

constexpr int kVersion = 1;

SpectralQuantity readQuantity(const nlohmann::json& table, const std::string& group, const std::string& where) {
  const std::string stated = requiredText(table, "quantity", where);
  // The daylight components are parts of a distribution and go below zero; an extinction is like a sensitivity, zero
  // outside its range; chromaticities, pixels, distributions of parameters, weights and bases are no spectra.
  if (group == "daylight_basis" || group == "chromophores" || group == "rgb_spaces" || group == "pixels" ||
      group == "skin_prior" || group == "skin_network" || group == "uplifts") {
    return SpectralQuantity::Sensitivity;
  }
  for (const SpectralQuantity quantity : {SpectralQuantity::SpectralPowerDistribution, SpectralQuantity::Sensitivity,
                                          SpectralQuantity::Reflectance, SpectralQuantity::Transmittance}) {
    if (stated == quantityName(quantity)) {
      return quantity;
    }
  }
  throw InputError(where, "quantity", stated,
                   "must be spectral power distribution, sensitivity, reflectance or transmittance");
}

Observer::Response readResponse(const nlohmann::json& table, const std::string& where) {
  const std::string stated = requiredText(table, "response", where);
  if (stated == "xyz") {
    return Observer::Response::Xyz;
  }
  if (stated == "lms") {
    return Observer::Response::Lms;
  }
  if (stated == "camera") {
    return Observer::Response::Camera;
  }
  throw InputError(where, "response", stated, "must be xyz, lms or camera");
}

/// `count` numbers of a list.
Eigen::VectorXd readNumbers(const nlohmann::json& list, Eigen::Index count, const std::string& where,
                            const std::string& field) {
  if (!list.is_array() || list.size() != static_cast<std::size_t>(count)) {
    throw InputError(where, field, valueText(list), "must be a list of " + std::to_string(count));
  }
  Eigen::VectorXd numbers(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const nlohmann::json& item = list[static_cast<std::size_t>(i)];
    if (!item.is_number()) {
      throw InputError(where, field, valueText(item), "must be a number");
    }
    numbers[i] = item.get<double>();
  }
  return numbers;
}

/// The rows of a list of lists.
Eigen::MatrixXd readRows(const nlohmann::json& list, Eigen::Index columns, const std::string& where,
                         const std::string& field) {
  if (!list.is_array() || list.size() != 3) {
    throw InputError(where, field, valueText(list), "must be a list of 3 lists");
  }
  Eigen::MatrixXd rows(3, columns);
  for (Eigen::Index i = 0; i < 3; ++i) {
    rows.row(i) = readNumbers(list[static_cast<std::size_t>(i)], columns, where, field).transpose();
  }
  return rows;
}

ManifestTable readTable(const nlohmann::json& entry, const std::string& manifest) {
  ManifestTable table;
  table.file = requiredText(entry, "file", manifest);
  const std::string where = manifest + ": " + table.file;
  requiredText(entry, "unit", where);
  table.licence = requiredText(entry, "licence", where);
  table.group = requiredText(entry, "group", where);
  table.source = requiredText(entry, "source", where);
  table.sha256 = requiredText(entry, "sha256", where);
  table.quantity = readQuantity(entry, table.group, where);
  const nlohmann::json& names = member(entry, "names");
  if (!names.is_array() || names.empty()) {
    throw InputError(where, "names", valueText(names), "must be a list of names");
  }
  for (const nlohmann::json& name : names) {
    if (!name.is_string()) {
      throw InputError(where, "names", valueText(name), "must be text in quotes");
    }
    table.names.push_back(name.get<std::string>());
  }
  const bool oneName = table.group == "observers" || table.group == "reflectances";
  if (oneName && table.names.size() != 1) {
    throw InputError(where, "names", std::to_string(table.names.size()), "the table has exactly one");
  }
  if (table.group == "observers") {
    table.response = readResponse(entry, where);
    if (const nlohmann::json& rows = member(entry, "to_xyz"); !rows.is_null()) {
      table.xyzFromResponse = Eigen::Matrix3d(readRows(rows, 3, where, "to_xyz"));
    }
  }
  return table;
}

}  // namespace

std::vector<ManifestTable> readManifest(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "manifest.json";
  const std::string where = utf8(file);
  const nlohmann::json document = parseJson(readTextFile(file), where);
  const nlohmann::json& version = member(document, "metamer_data");
  if (!version.is_number_integer() || version != kVersion) {
    throw InputError(where, "metamer_data", valueText(version),
                     "must be " + std::to_string(kVersion) + "; use the data folder of this release");
  }
  const nlohmann::json& entries = member(document, "tables");
  if (!entries.is_array()) {
    throw InputError(where, "tables", "", "must be a list");
  }
  std::vector<ManifestTable> tables;
  for (const nlohmann::json& entry : entries) {
    tables.push_back(readTable(entry, where));
  }
  return tables;
}

std::vector<RgbSpace> readRgbSpaces(const std::filesystem::path& file) {
  const std::string where = utf8(file);
  const nlohmann::json document = parseJson(readTextFile(file), where);
  const nlohmann::json& entries = member(document, "spaces");
  if (!entries.is_array()) {
    throw InputError(where, "spaces", "", "must be a list");
  }
  std::vector<RgbSpace> spaces;
  for (const nlohmann::json& entry : entries) {
    RgbSpace space;
    space.name = requiredText(entry, "name", where);
    const std::string spaceWhere = where + ": " + space.name;
    const Eigen::MatrixXd primaries = readRows(member(entry, "primaries"), 2, spaceWhere, "primaries");
    for (Eigen::Index k = 0; k < 3; ++k) {
      space.primaries[static_cast<std::size_t>(k)] = primaries.row(k).transpose();
    }
    space.white = readNumbers(member(entry, "white"), 2, spaceWhere, "white");
    // Written so that NaN, from primaries on one line, is refused as well.
    const Eigen::Matrix3d matrix = space.white.y() == 0 ? Eigen::Matrix3d::Zero() : space.xyzFromRgb();
    if (!(std::abs(matrix.determinant()) > 1e-9)) {
      throw InputError(spaceWhere, "primaries", "", "span no triangle, or the white has y = 0");
    }
    spaces.push_back(std::move(space));
  }
  return spaces;
}

}  // namespace metamer::spectral
