// SPDX-License-Identifier: Apache-2.0
#include "stage/stage_json.h"

#include <cmath>

#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"

namespace metamer::lutgen {

Json numberToJson(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json toJson(const Eigen::Ref<const Eigen::VectorXd>& values) {
  Json list = Json::array();
  for (const double value : values) {
    list.push_back(numberToJson(value));
  }
  return list;
}

Json rowsToJson(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  Json rows = Json::array();
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    rows.push_back(toJson(matrix.row(row).transpose()));
  }
  return rows;
}

std::string relativeTo(const std::filesystem::path& report, const std::filesystem::path& file) {
  if (file.empty()) {
    return {};
  }
  return spectral::utf8(std::filesystem::proximate(file, std::filesystem::absolute(report).parent_path()));
}

void writeJson(const std::filesystem::path& file, const Json& json) {
  // Bytes of a name that are not UTF-8 are replaced: the file must stay JSON.
  spectral::writeWholeFile(file, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace metamer::lutgen
