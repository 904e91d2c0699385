// SPDX-License-Identifier: Apache-2.0
#include "apply/icc_profile.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <string_view>

#include "exr/zip_block.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/picture_file.h"

namespace metamer::lutgen {
namespace {

/// Of the header, ICC.1:2022 table 17.
constexpr std::size_t kColoursAt = 16;
constexpr std::size_t kColoursEnd = 20;
/// A larger profile is none.
constexpr std::size_t kLargestProfile = 1U << 26U;
constexpr std::size_t kLongestName = 80;

std::string coloursOf(std::string_view profile) {
  return profile.size() < kColoursEnd ? "" : std::string(profile.substr(kColoursAt, kColoursEnd - kColoursAt));
}

/// What a PNG's chunk iCCP holds: a name, a zero, the way of packing, the profile packed.
std::string profileOfPng(const std::string& file) {
  std::ifstream stream(spectral::pathOf(file), std::ios::binary);
  std::array<char, 8> head{};
  if (!stream.read(head.data(), head.size()) || std::string_view(head.data(), head.size()) != spectral::kPngSignature) {
    return "";
  }
  while (stream.read(head.data(), head.size())) {
    const std::uint32_t size = spectral::bigEndian(head.data());
    const std::string_view name(head.data() + 4, 4);
    if (name == "IDAT" || name == "IEND" || size > kLargestProfile) {
      break;  // profiles stand before pixels
    }
    std::string content(size, '\0');
    stream.read(content.data(), static_cast<std::streamsize>(size));
    stream.ignore(4);
    const std::size_t zero = content.find('\0');
    if (stream && name == "iCCP" && zero < kLongestName && zero + 2 < content.size()) {
      return inflated(std::string_view(content).substr(zero + 2), kLargestProfile);
    }
  }
  return "";
}

}  // namespace

std::string coloursOfProfile(const OIIO::ImageSpec& spec, const std::string& file) {
  const OIIO::ParamValue* profile = spec.find_attribute("ICCProfile");
  if (profile != nullptr && profile->type().basetype == OIIO::TypeDesc::UINT8) {
    return coloursOf({static_cast<const char*>(profile->data()), static_cast<std::size_t>(profile->datasize())});
  }
  return coloursOf(profileOfPng(file));
}

}  // namespace metamer::lutgen
