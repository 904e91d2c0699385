// SPDX-License-Identifier: Apache-2.0
#include "guide_dump.h"

#include <nlohmann/json.hpp>

#include "metamer/spectral/pending_file.h"

namespace metamer::spectral_ref {

void writeGuideDump(const Renderer& renderer, const std::vector<std::array<int, 2>>& pixels,
                    const std::filesystem::path& file) {
  nlohmann::json document;
  document["first_nm"] = spectral::kDomainStartNm;
  document["pixels"] = nlohmann::json::array();
  for (const auto& [x, y] : pixels) {
    if (const auto learnt = renderer.wavelengthDensity(x, y)) {
      document["pixels"].push_back({{"x", x},
                                    {"y", y},
                                    {"own", learnt->isOwn},
                                    {"density", std::vector<double>(learnt->density.begin(), learnt->density.end())},
                                    {"histogram", learnt->histogram}});
    }
  }
  spectral::writeWholeFile(file, document.dump(1) + "\n");
}

}  // namespace metamer::spectral_ref
