// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace metamer::lutgen {

/// OpenEXR's ZIP and ZIPS: low and high bytes apart, differences, deflate. Safe on several threads.

/// @param size  of what was packed
/// @return empty where the bytes are damaged
std::string unzippedBlock(std::string_view packed, std::size_t size);

/// The bytes as they are where packing does not make them fewer.
std::string zippedBlock(std::string_view block);

}  // namespace metamer::lutgen
