// SPDX-License-Identifier: Apache-2.0
#include "apply/picture_clues.h"

#include <set>

#include "apply/icc_profile.h"
#include "metamer/spectral/path_text.h"

namespace metamer::lutgen {

SpaceClues cluesOf(const AnyPicture& picture, const ColourLayer& layer) {
  const OIIO::ImageSpec& spec = picture.spec(layer.part);
  SpaceClues clues;
  clues.format = picture.format();
  clues.named = spec.get_string_attribute("colorInteropID", spec.get_string_attribute("oiio:ColorSpace"));
  if (const std::string transfer = spec.get_string_attribute("dpx:Transfer");
      clues.named.empty() && transfer == "Printing density") {
    clues.named = transfer;
  }
  for (const char* key : {"jpeg:ColorSpace", "tiff:ColorSpace", "psd:ColorMode"}) {
    clues.isInks = clues.isInks || spec.get_string_attribute(key) == "CMYK" || spec.get_string_attribute(key) == "YCCK";
  }
  clues.profileColours = coloursOfProfile(spec, picture.file());
  clues.profile = spec.get_string_attribute("ICCProfile:profile_description");
  std::array<float, 8> xy{};
  if (spec.getattribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), xy.data())) {
    clues.chromaticities = xy;
  }
  clues.isFloat = spec.channelformat(layer.channels[0]).is_floating_point();
  return clues;
}

bool isSrgbFormat(const std::string& format) {
  static const std::set<std::string> formats = {"png", "jpeg", "gif", "bmp", "targa", "webp", "heif"};
  return formats.count(format) != 0;
}

std::string formatOf(const std::filesystem::path& output) {
  const auto format = OIIO::ImageOutput::create(spectral::utf8(output));
  if (!format) {
    OIIO::geterror();  // whoever writes says it; what is not fetched is printed at the end
    return "";
  }
  return format->format_name();
}

std::array<float, 8> chromaticitiesOf(const spectral::RgbSpace& space) {
  std::array<float, 8> xy{};
  for (std::size_t k = 0; k < 3; ++k) {
    xy[2 * k] = static_cast<float>(space.primaries[k].x());
    xy[2 * k + 1] = static_cast<float>(space.primaries[k].y());
  }
  xy[6] = static_cast<float>(space.white.x());
  xy[7] = static_cast<float>(space.white.y());
  return xy;
}

}  // namespace metamer::lutgen
