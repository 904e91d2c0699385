// SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include "encoded_pixels.h"
#include "transform.h"

namespace metamer::python {
namespace {

std::size_t bytesOf(const sip::HomogeneousMap& tables) {
  return tables.patches.size() * sizeof(sip::HomogeneousMap::Patch) +
         (tables.patchIndex.size() + tables.roots.size()) * sizeof(std::uint32_t) + tables.fine.size() * sizeof(float);
}

constexpr const char* kCall =
    "As Transform's call, float32 through the same kernel as lutgen apply --engine map; float64 pixels go through\n"
    "float32.";

}  // namespace

PixelFunction Map::linearFunction() const {
  return {[this](std::span<const float> source, std::span<float> destination) { tables.apply(source, destination); },
          [this](std::span<Eigen::Vector3d> colours) {
            for (Eigen::Vector3d& rgb : colours) {
              std::array<float, 4> pixel = {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]),
                                            static_cast<float>(rgb[2]), 1.0F};
              tables.apply(pixel);
              rgb = {pixel[0], pixel[1], pixel[2]};
            }
          }};
}

PixelFunction Map::function() const {
  return onEncoded(linearFunction(), tables.identity ? std::nullopt : encoding);
}

void bindMap(nb::module_& module) {
  nb::class_<Map> binding(module, "Map", "A transform as a table over directions of RGB: fast, at any exposure.");
  defineCall(
      binding, [](const Map& self) { return self.function(); }, kCall);
  binding.def_prop_ro("patches", [](const Map& self) { return self.tables.patches.size(); })
      .def_prop_ro(
          "bytes", [](const Map& self) { return bytesOf(self.tables); }, "Of its tables.")
      .def_prop_ro(
          "solves", [](const Map& self) { return self.tables.statistics.solves; },
          "Exact colours that it was made from.")
      .def_prop_ro(
          "largest_error", [](const Map& self) { return self.tables.statistics.largestError; },
          "At the points checked while it was made, about CIEDE2000 at Y = 0.18.");
}

}  // namespace metamer::python
