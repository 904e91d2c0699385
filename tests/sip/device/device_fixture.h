// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "metamer/sip/device_kernels.h"

namespace metamer::sip {

/// A map with its tables for devices.
struct DeviceCase {
  std::string name;
  HomogeneousMap map;
  DeviceTables tables;
};

/// Twelve: lights smooth and spiky, of the smooth scene and the natural one, seen by eyes and by cameras; the last
/// changes nothing. Built once.
const std::vector<DeviceCase>& deviceCases();

/// RGBA pixels of every kind: natural, saturated, negative, from -20 to +20 stops, black, denormals, the largest
/// numbers, infinities, NaN.
std::vector<float> pixelsOfEveryKind(std::size_t count, unsigned seed);

/// The floats whose bits differ; `first` says which was the first.
std::size_t differingBits(std::span<const float> expected, std::span<const float> given, std::string& first);

}  // namespace metamer::sip
