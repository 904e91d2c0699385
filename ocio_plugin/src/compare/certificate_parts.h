// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "metamer/ocio/certificate_record.h"

// What reading, comparing and ageing of certificates share.
namespace metamer::ocio {

/// @throws nlohmann::json::exception; spectral::InputError where it nests deeper than any certificate
nlohmann::ordered_json certificateJson(const std::string& text);

/// Adds what a part of two certificates says differently.
void compareParts(const nlohmann::ordered_json& a, const nlohmann::ordered_json& b, const std::string& part,
                  std::vector<CertificateChange>& changes);

}  // namespace metamer::ocio
