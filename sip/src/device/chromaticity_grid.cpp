// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/chromaticity_grid.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "device/device_texts.h"
#include "metamer/spectral/argument_checks.h"

namespace metamer::sip {
namespace {

using Grid = ChromaticityGrid;
using Rows = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;

constexpr std::size_t kNodes = std::size_t{Grid::kCubeSide} * Grid::kCubeSide * Grid::kCubeSide;
static_assert(std::size_t{Grid::kSide} * Grid::kSide <= kNodes);

/// Digits after the point: a step is 1e-7 of the range.
constexpr float kSteps = 1e7F;

/// The map at the grid's nodes, pixels whose third coordinate is 1.
std::vector<float> valuesOf(const HomogeneousMap& map) {
  const Eigen::Matrix3d rgbFromCube = Eigen::Map<const Rows>(map.cubeFromRgb.data()).cast<double>().inverse();
  std::vector<float> pixels;
  pixels.reserve(4 * std::size_t{Grid::kSide} * Grid::kSide);
  const auto along = [](int k) { return 2.0 * k / (Grid::kSide - 1) - 1.0; };
  for (int row = 0; row < Grid::kSide; ++row) {
    for (int column = 0; column < Grid::kSide; ++column) {
      const Eigen::Vector3f rgb = (rgbFromCube * Eigen::Vector3d(along(column), along(row), 1.0)).cast<float>();
      pixels.insert(pixels.end(), {rgb[0], rgb[1], rgb[2], 1.0F});
    }
  }
  map.apply(pixels);
  return pixels;
}

// The text for the processor: what Resolve's language defines, and the macros of its prelude.
struct float3 {
  float x;
  float y;
  float z;
};

float3 make_float3(float x, float y, float z) {
  return {x, y, z};
}

/// Reads at nodes alone, as the text promises to.
float3 nodeAt(const Grid& grid, float red, float green, float blue) {
  const auto at = [](float coordinate) { return static_cast<std::size_t>(coordinate * (Grid::kCubeSide - 1)); };
  const auto& node = grid.nodes[(at(blue) * Grid::kCubeSide + at(green)) * Grid::kCubeSide + at(red)];
  return {node[0], node[1], node[2]};
}

#define __DEVICE__ [[maybe_unused]] inline
#define METAMER_GRID , [[maybe_unused]] const Grid& grid
#define METAMER_GRID_GIVEN , grid
#define METAMER_NUMBER(i) grid.numbers[static_cast<std::size_t>(i)]
#define METAMER_GAIN 1.0F
#define METAMER_MIX 1.0F
#define APPLY_LUT(red, green, blue, table) nodeAt(grid, (red), (green), (blue))
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include "device/text/dctl.body"
#pragma GCC diagnostic pop

}  // namespace

ChromaticityGrid chromaticityGrid(const HomogeneousMap& map) {
  Grid grid;
  grid.nodes.resize(kNodes);
  auto next = grid.numbers.begin();
  std::vector<float> values;
  if (map.identity) {
    // One half-space that holds every colour, and the matrix that changes none.
    const Rows same = Rows::Identity();
    next = std::copy(same.data(), same.data() + 9, next);
    std::copy(same.data(), same.data() + 9, next);
    grid.numbers[44] = 1.0F;
    return grid;
  }
  next = std::copy(map.cubeFromRgb.begin(), map.cubeFromRgb.end(), next);
  next = std::copy(map.linearMatrix.begin(), map.linearMatrix.end(), next);
  std::copy(map.linearNormals.begin(), map.linearNormals.end(), next);
  const auto cubeFromRgb = Eigen::Map<const Rows>(map.cubeFromRgb.data()).cast<double>();
  const auto matrix = Eigen::Map<const Rows>(map.linearMatrix.data()).cast<double>();
  Eigen::Map<Rows>(grid.numbers.data() + 45) = (matrix * cubeFromRgb.inverse()).cast<float>();
  values = valuesOf(map);
  float low = values[0];
  float high = values[0];
  for (std::size_t i = 0; i < values.size(); ++i) {
    low = i % 4 == 3 ? low : std::min(low, values[i]);
    high = i % 4 == 3 ? high : std::max(high, values[i]);
  }
  const float range = high > low ? high - low : 1.0F;
  grid.numbers[42] = low;
  grid.numbers[43] = range;
  grid.numbers[44] = static_cast<float>(map.linearNormalCount);
  for (std::size_t i = 0; i < values.size() / 4; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      grid.nodes[i][k] = std::round((values[4 * i + k] - low) / range * kSteps) / kSteps;
    }
  }
  return grid;
}

std::string dctlText(const ChromaticityGrid& grid) {
  std::string text(deviceTextPart("dctl.prelude"));
  std::array<char, 64> word{};
  text += "__CONSTANT__ float metamerNumbers[] = {";
  for (std::size_t i = 0; i < grid.numbers.size(); ++i) {
    std::snprintf(word.data(), word.size(), "%s%.9ef",
                  i == 0       ? ""
                  : i % 6 == 0 ? ",\n  "
                               : ", ",
                  static_cast<double>(grid.numbers[i]));
    text += word.data();
  }
  text += "};\n\nDEFINE_CUBE_LUT(metamerTable)\n{\nLUT_3D_SIZE 65\n";
  text.reserve(text.size() + 30 * grid.nodes.size());
  for (const auto& node : grid.nodes) {
    std::snprintf(word.data(), word.size(), "%.7f %.7f %.7f\n", static_cast<double>(node[0]),
                  static_cast<double>(node[1]), static_cast<double>(node[2]));
    text += word.data();
  }
  text += "}\n\n";
  text += deviceTextPart("dctl.body");
  return text;
}

void applyChromaticityGrid(const ChromaticityGrid& grid, std::span<float> rgba) {
  spectral::requirePixels(static_cast<std::int64_t>(rgba.size()));
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    const float3 result = transform(1, 1, 0, 0, rgba[i], rgba[i + 1], rgba[i + 2], grid);
    rgba[i] = result.x;
    rgba[i + 1] = result.y;
    rgba[i + 2] = result.z;
  }
}

}  // namespace metamer::sip
