// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/device_kernels.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "device/device_texts.h"
#include "metamer/spectral/argument_checks.h"

namespace metamer::sip {
namespace {

#include "device/text/constants.prelude"

using Map = HomogeneousMap;

static_assert(METAMER_FINE_BITS == Map::kFineBits && METAMER_FINE_SIDE == Map::kFineSide);
static_assert(METAMER_DEPTH_BITS == Map::kDepthBits && METAMER_MAXIMUM_DEPTH == Map::kMaximumDepth);
static_assert(METAMER_FRONT_FACE == Map::kFrontFace);
static_assert(Map::kRootBits == std::array{METAMER_OTHER_ROOT_BITS, METAMER_OTHER_ROOT_BITS, METAMER_OTHER_ROOT_BITS,
                                           METAMER_OTHER_ROOT_BITS, METAMER_FRONT_ROOT_BITS, METAMER_OTHER_ROOT_BITS});
static_assert(METAMER_FIRST_FINE == 6 + Map::kMostLinearNormals);
static_assert(4 * METAMER_PATCH_NODES >= sizeof(Map::Patch) / sizeof(float));

/// Cells before the first root.
constexpr std::uint32_t kFirstRoot = 2 + Map::kFaceCount;

struct Names {
  std::string_view name;  ///< of the dialect
  std::string_view file;  ///< of its texts
};

Names namesOf(DeviceDialect dialect) {
  switch (dialect) {
    case DeviceDialect::OpenCl:
      return {"OpenCL C", "opencl"};
    case DeviceDialect::Cuda:
      return {"CUDA C++", "cuda"};
    case DeviceDialect::Metal:
      return {"Metal", "metal"};
    case DeviceDialect::Glsl:
      return {"GLSL", "glsl"};
    case DeviceDialect::Hlsl:
      return {"HLSL", "hlsl"};
  }
  return {};
}

/// Rows of three, each a node.
void appendRows(std::span<const float> rows, DeviceTables& tables) {
  for (std::size_t i = 0; i < rows.size(); i += 3) {
    tables.nodes.push_back({rows[i], rows[i + 1], rows[i + 2], 0.0F});
  }
}

void appendPatch(const Map::Patch& patch, DeviceTables& tables) {
  std::array<float, std::size_t{4} * METAMER_PATCH_NODES> flat{};
  auto end = std::copy(patch.coefficients.begin(), patch.coefficients.end(), flat.begin());
  *end++ = patch.scale;
  std::copy(patch.offset.begin(), patch.offset.end(), end);
  for (std::size_t i = 0; i < flat.size(); i += 4) {
    tables.nodes.push_back({flat[i], flat[i + 1], flat[i + 2], flat[i + 3]});
  }
}

}  // namespace

std::string_view nameOf(DeviceDialect dialect) {
  return namesOf(dialect).name;
}

std::string deviceText(DeviceDialect dialect, DeviceKernel kernel) {
  const std::string file(namesOf(dialect).file);
  const bool isMap = kernel == DeviceKernel::Map;
  std::string text;
  if (dialect == DeviceDialect::Glsl) {
    text += "#version 430\n";
  }
  text += deviceTextPart("constants.prelude");
  text += deviceTextPart(file + ".prelude");
  text += "\n";
  text += deviceTextPart("common.body");
  text += "\n";
  text += deviceTextPart(isMap ? "map.body" : "affine.body");
  text += "\n#ifndef METAMER_NO_ENTRY";
  text += deviceTextPart(file + ".entry");
  text +=
      isMap ? "METAMER_ENTRY(metamerMapPixels, metamerMap)\n" : "METAMER_ENTRY(metamerAffinePixels, metamerAffine)\n";
  text += "#endif\n";
  return text;
}

DeviceTables deviceTables(const HomogeneousMap& map) {
  DeviceTables tables;
  tables.nodes.reserve(METAMER_FIRST_FINE + map.fine.size() / 4 + METAMER_PATCH_NODES * map.patches.size());
  appendRows(map.cubeFromRgb, tables);
  appendRows(map.linearMatrix, tables);
  appendRows(map.linearNormals, tables);
  for (std::size_t i = 0; i < map.fine.size(); i += 4) {
    tables.nodes.push_back({map.fine[i], map.fine[i + 1], map.fine[i + 2], map.fine[i + 3]});
  }
  const auto firstPatch = static_cast<std::uint32_t>(tables.nodes.size());
  for (const Map::Patch& patch : map.patches) {
    appendPatch(patch, tables);
  }
  const auto firstIndex = kFirstRoot + static_cast<std::uint32_t>(map.roots.size());
  tables.cells = {static_cast<std::uint32_t>(map.linearNormalCount), map.identity ? 1U : 0U};
  for (const std::uint32_t offset : map.faceOffset) {
    tables.cells.push_back(kFirstRoot + offset);
  }
  for (const std::uint32_t root : map.roots) {
    tables.cells.push_back(root + (firstIndex << Map::kDepthBits));
  }
  for (const std::uint32_t patch : map.patchIndex) {
    tables.cells.push_back(firstPatch + METAMER_PATCH_NODES * patch);
  }
  return tables;
}

DeviceTables deviceTables(const AffineForm& form) {
  DeviceTables tables;
  for (std::size_t row = 0; row < 3; ++row) {
    tables.nodes.push_back(
        {form.matrix[3 * row], form.matrix[3 * row + 1], form.matrix[3 * row + 2], form.offset[row]});
  }
  tables.nodes.push_back({form.clampsBelow ? 1.0F : 0.0F, 0.0F, 0.0F, 0.0F});
  return tables;
}

}  // namespace metamer::sip
