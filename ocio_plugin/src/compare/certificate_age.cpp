// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "compare/certificate_parts.h"
#include "metamer/ocio/certificate.h"
#include "metamer/ocio/certificate_record.h"

namespace metamer::ocio {

using Json = nlohmann::ordered_json;

std::vector<CertificateChange> staleParts(const CertificateRecord& certificate, const sip::Recipe& recipe,
                                          const spectral::DataLibrary& library) {
  Certificate now;
  now.recipe = recipe;
  now.inputs = certifiedInputs(recipe, library);
  const Json a = certificateJson(certificate.text);
  const Json b = Json::parse(now.json());
  std::vector<CertificateChange> changes;
  for (const char* part : {"inputs", "recipe", "tool"}) {
    compareParts(a, b, part, changes);
  }
  // A name is not what a transform does.
  changes.erase(
      std::remove_if(changes.begin(), changes.end(),
                     [](const CertificateChange& change) { return change.part == "recipe" && change.field == "name"; }),
      changes.end());
  return changes;
}

}  // namespace metamer::ocio
