// SPDX-License-Identifier: Apache-2.0
#include "sip/device/metal_text.h"

#include <metal_stdlib>

// The texts as deviceText() gives them, written by the build.
namespace metal_map {
#include "map.metal"
}  // namespace metal_map

// Each text is a file of its own: what both define is defined anew.
#undef METAMER_ENTRY
namespace metal_affine {
#include "affine.metal"
}  // namespace metal_affine

namespace metamer::sip {
namespace {

template <typename Kernel>
std::vector<float> run(Kernel* kernelOfText, const DeviceTables& tables, const std::vector<float>& pixels) {
  static_assert(sizeof(metal::float4) == 4 * sizeof(float));
  const metal::uint pixelCount = static_cast<metal::uint>(pixels.size() / 4);
  std::vector<metal::float4> source;
  source.reserve(pixelCount);
  for (std::size_t i = 0; i < pixels.size(); i += 4) {
    source.emplace_back(pixels[i], pixels[i + 1], pixels[i + 2], pixels[i + 3]);
  }
  std::vector<metal::float4> nodes;
  nodes.reserve(tables.nodes.size());
  for (const auto& node : tables.nodes) {
    nodes.emplace_back(node[0], node[1], node[2], node[3]);
  }
  std::vector<metal::float4> destination = source;
  // One thread more than there are pixels: it must not write.
  for (metal::uint at = 0; at <= pixelCount; ++at) {
    kernelOfText(source.data(), destination.data(), pixelCount, nodes.data(), tables.cells.data(), at);
  }
  std::vector<float> result;
  result.reserve(pixels.size());
  for (const metal::float4& pixel : destination) {
    result.insert(result.end(), {pixel.x, pixel.y, pixel.z, pixel.w});
  }
  return result;
}

}  // namespace

std::vector<float> runMetalMap(const DeviceTables& tables, const std::vector<float>& pixels) {
  return run(metal_map::metamerMapPixels, tables, pixels);
}

std::vector<float> runMetalAffine(const DeviceTables& tables, const std::vector<float>& pixels) {
  return run(metal_affine::metamerAffinePixels, tables, pixels);
}

}  // namespace metamer::sip
