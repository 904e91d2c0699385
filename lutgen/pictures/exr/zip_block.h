// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace metamer::lutgen {

/// OpenEXR's ZIP and ZIPS: low and high bytes apart, differences, deflate. Safe on several threads.

/// @param size  of what was packed
/// @return empty where the bytes are damaged
std::string unzippedBlock(std::string_view packed, std::size_t size);

/// A zlib stream by itself.
/// @param most  bytes that are taken
/// @return empty where it is damaged or longer
std::string inflated(std::string_view packed, std::size_t most);

/// As OpenEXR has packed since 3.1.3.
inline constexpr int kUsualZipLevel = 4;
/// A sixth of the time (by ISA-L), and of many channels that are alike 3 % more bytes.
inline constexpr int kFastZipLevel = 1;

/// The bytes as they are where packing does not make them fewer.
/// @param level  of deflate, 1 ... 9
std::string zippedBlock(std::string_view block, int level = kUsualZipLevel);

}  // namespace metamer::lutgen
