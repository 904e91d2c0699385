// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "metamer/sip/homogeneous_map.h"

namespace metamer::sip {

/// Languages of other devices and of viewers that the kernels are written in.
enum class DeviceDialect { OpenCl, Cuda, Metal, Glsl, Hlsl };

inline constexpr std::array kDeviceDialects = {DeviceDialect::OpenCl, DeviceDialect::Cuda, DeviceDialect::Metal,
                                               DeviceDialect::Glsl, DeviceDialect::Hlsl};

/// "OpenCL C", "CUDA C++", "Metal", "GLSL", "HLSL".
std::string_view nameOf(DeviceDialect dialect);

/// What a kernel does to a pixel.
enum class DeviceKernel { Map, Affine };

/// A kernel in a language: a prelude, a body that is the same text in each, an entry. It defines
/// `float4 metamerMap(float4 pixel, tables)` or `metamerAffine`, and an entry over packed RGBA float pixels, named
/// `metamerMapPixels` or `metamerAffinePixels` (GLSL: `main`; left out where METAMER_NO_ENTRY is defined). The prelude
/// says how to compile it so that results are the processor's to the bit.
std::string deviceText(DeviceDialect dialect, DeviceKernel kernel);

/// The tables of a kernel, as a caller uploads them: two buffers, read only.
struct DeviceTables {
  std::vector<std::array<float, 4>> nodes;
  std::vector<std::uint32_t> cells;  ///< empty for DeviceKernel::Affine
};

/// The tables of DeviceKernel::Map. @param map  a pixel becomes what map.apply() makes of it
DeviceTables deviceTables(const HomogeneousMap& map);

/// A matrix and an offset on linear pixels.
struct AffineForm {
  std::array<float, 9> matrix = {1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< rows red, green, blue
  std::array<float, 3> offset{};
  bool clampsBelow = false;  ///< no result below 0
};

/// The tables of DeviceKernel::Affine.
DeviceTables deviceTables(const AffineForm& form);

/// What a device makes of RGBA pixels: the same text, compiled for the processor, one pixel after the other. Slow; for
/// judging tables that were written and read again.
/// @param tables  of deviceTables() for this kernel
/// @throws spectral::InputError for half a pixel
void applyDeviceKernel(DeviceKernel kernel, const DeviceTables& tables, std::span<float> rgba);

}  // namespace metamer::sip
