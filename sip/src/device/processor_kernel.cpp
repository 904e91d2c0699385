// SPDX-License-Identifier: Apache-2.0
// The devices' text for the processor: one more prelude.
#include <bit>
#include <cmath>
#include <cstdint>

#include "metamer/sip/device_kernels.h"
#include "metamer/spectral/argument_checks.h"

namespace metamer::sip {
namespace {

using uint = std::uint32_t;

struct float4 {
  float x;
  float y;
  float z;
  float w;
};

// What the preludes of text/ define too.
#define METAMER_FUNCTION inline
#define METAMER_STRUCT(name) struct name
#define METAMER_TABLES , const DeviceTables& tables
#define METAMER_TABLES_GIVEN , tables
#define METAMER_NODE(i) nodeOf(tables, i)
#define METAMER_CELL(i) tables.cells[i]
#define METAMER_FLOAT4(x, y, z, w) \
  float4 {                         \
    (x), (y), (z), (w)             \
  }
#define METAMER_INT(x) static_cast<int>(x)
#define METAMER_UINT(x) static_cast<uint>(x)
#define METAMER_FLOAT(x) static_cast<float>(x)
#define metamerBits(x) std::bit_cast<uint>(x)
#define metamerFloat(x) std::bit_cast<float>(x)
#define metamerFused(a, b, c) std::fma((a), (b), (c))
#define metamerTimes(a, b) ((a) * (b))
#define metamerPlus(a, b) ((a) + (b))
#define metamerMinus(a, b) ((a) - (b))
#define metamerQuotient(a, b) ((a) / (b))

inline float4 nodeOf(const DeviceTables& tables, uint index) {
  const auto& node = tables.nodes[index];
  return {node[0], node[1], node[2], node[3]};
}

#include "device/text/constants.prelude"
//
#include "device/text/common.body"
//
#include "device/text/affine.body"
#include "device/text/map.body"

}  // namespace

void applyDeviceKernel(DeviceKernel kernel, const DeviceTables& tables, std::span<float> rgba) {
  spectral::requirePixels(static_cast<std::int64_t>(rgba.size()));
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    const float4 pixel{rgba[i], rgba[i + 1], rgba[i + 2], rgba[i + 3]};
    const float4 result = kernel == DeviceKernel::Map ? metamerMap(pixel, tables) : metamerAffine(pixel, tables);
    rgba[i] = result.x;
    rgba[i + 1] = result.y;
    rgba[i + 2] = result.z;
    rgba[i + 3] = result.w;
  }
}

}  // namespace metamer::sip
