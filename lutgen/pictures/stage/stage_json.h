// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace metamer::lutgen {

using Json = nlohmann::ordered_json;

/// A list of numbers; one that is not finite becomes null.
Json toJson(const Eigen::Ref<const Eigen::VectorXd>& values);
/// A list of rows.
Json rowsToJson(const Eigen::Ref<const Eigen::MatrixXd>& matrix);
/// A number, null where it is not finite.
Json numberToJson(double value);

/// A file as a report beside it names it; empty for none.
std::string relativeTo(const std::filesystem::path& report, const std::filesystem::path& file);

/// Writes a file whole or not at all.
/// @throws spectral::InputError
void writeJson(const std::filesystem::path& file, const Json& json);

}  // namespace metamer::lutgen
