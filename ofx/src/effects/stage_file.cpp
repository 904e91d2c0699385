// SPDX-License-Identifier: Apache-2.0
#include "effects/stage_file.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_files.h"

namespace metamer::ofx {
namespace {

using nlohmann::json;
using spectral::InputError;

constexpr const char* kRemedy = "write the file with lutgen stage solve";

const json& member(const json& root, const std::string& where, const char* key) {
  const auto found = root.find(key);
  if (found == root.end()) {
    throw InputError(where, key, "", std::string("is missing; ") + kRemedy);
  }
  return *found;
}

Eigen::RowVector3d readRow(const json& value, const std::string& where, const std::string& key) {
  Eigen::RowVector3d row;
  if (!value.is_array() || value.size() != 3) {
    throw InputError(where, key, value.dump(), "must be three numbers");
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (!value[k].is_number() || !std::isfinite(value[k].get<double>())) {
      throw InputError(where, key, value[k].dump(), "must be a finite number");
    }
    row[static_cast<Eigen::Index>(k)] = value[k].get<double>();
  }
  return row;
}

Eigen::Matrix3d readMatrix(const json& root, const std::string& where, const char* key) {
  const json& value = member(root, where, key);
  if (!value.is_array() || value.size() != 3) {
    throw InputError(where, key, value.dump(), "must be three rows of three numbers");
  }
  Eigen::Matrix3d matrix;
  for (std::size_t row = 0; row < 3; ++row) {
    matrix.row(static_cast<Eigen::Index>(row)) =
        readRow(value[row], where, std::string(key) + "[" + std::to_string(row) + "]");
  }
  return matrix;
}

}  // namespace

Stage readStageFile(const std::filesystem::path& file) {
  return parseStageFile(spectral::readTextFile(file), spectral::utf8(file));
}

Stage parseStageFile(const std::string& text, const std::string& where) {
  // Deep nesting is refused by depth before the parser builds it.
  constexpr int kDeepest = 32;
  const json::parser_callback_t shallow = [&](int depth, json::parse_event_t, json&) {
    if (depth > kDeepest) {
      throw InputError(where, "", "", "is nested too deeply for a stage file");
    }
    return true;
  };
  json root;
  try {
    root = json::parse(text, shallow);
  } catch (const json::parse_error& error) {
    // Its own message quotes the file at any length.
    throw InputError(where, "", "", "is not JSON from byte " + std::to_string(error.byte) + " on; " + kRemedy);
  } catch (const json::exception&) {
    throw InputError(where, "", "", std::string("is not JSON: a number is out of range; ") + kRemedy);
  }
  if (!root.is_object()) {
    throw InputError(where, "", "", "must be a JSON object with M, Q, N and offset");
  }
  Stage stage;
  stage.m = readMatrix(root, where, "M");
  stage.q = readMatrix(root, where, "Q");
  stage.n = readMatrix(root, where, "N");
  stage.offset = readRow(member(root, where, "offset"), where, "offset").transpose();
  return stage;
}

}  // namespace metamer::ofx
