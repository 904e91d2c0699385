// SPDX-License-Identifier: Apache-2.0
#include "scene_file/scene_pixels.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/library_words.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/picture_file.h"
#include "metamer/spectral/spectral_picture.h"

namespace metamer::spectral_ref {

Pixels readPixels(const YamlValue& value, const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / spectral::pathOf(value.text());
  try {
    spectral::requirePictureFile(spectral::utf8(file));
  } catch (const spectral::InputError& error) {
    throw value.error("", error.what());
  }
  const auto input = OIIO::ImageInput::open(spectral::utf8(file));
  if (!input) {
    const std::string reason = OIIO::geterror();
    throw value.error("", "'" + spectral::utf8(file) + "' cannot be read: " + spectral::pictureReason(reason));
  }
  const OIIO::ImageSpec& spec = input->spec();
  constexpr std::uint64_t kMostPixels = 1U << 26U;
  if (spec.image_pixels() > kMostPixels || spec.deep || spec.image_pixels() == 0) {
    throw value.error(
        "", "'" + spectral::utf8(file) + "' is empty, deep or has more than 2^26 pixels; give a plain picture");
  }
  constexpr std::uint64_t kMostValues = 1U << 30U;
  if (spec.image_pixels() * static_cast<std::uint64_t>(spec.nchannels) > kMostValues) {
    throw value.error("", "'" + spectral::utf8(file) + "' has more than 2^30 values; give fewer pixels or channels");
  }
  Pixels pixels{spec.width, spec.height, spec.nchannels, spec.channelnames, spec.format.is_floating_point(), {}};
  pixels.values.resize(spec.image_pixels() * static_cast<std::size_t>(spec.nchannels));
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, pixels.values.data())) {
    throw value.error("",
                      "'" + spectral::utf8(file) + "' cannot be read: " + spectral::pictureReason(input->geterror()));
  }
  for (const float v : pixels.values) {
    if (!std::isfinite(v)) {
      throw value.error("", "'" + spectral::utf8(file) + "' has a value that is no finite number; mend the picture");
    }
  }
  return pixels;
}

std::vector<std::pair<double, int>> spectralChannels(const Pixels& pixels, spectral::SpectralQuantity quantity) {
  std::vector<std::pair<double, int>> channels;
  for (int c = 0; c < pixels.channels; ++c) {
    const auto nm = spectral::channelWavelengthNm(pixels.names[static_cast<std::size_t>(c)], quantity);
    if (nm) {
      channels.emplace_back(*nm, c);
    }
  }
  std::sort(channels.begin(), channels.end());
  const auto same = std::adjacent_find(channels.begin(), channels.end(),
                                       [](const auto& a, const auto& b) { return a.first == b.first; });
  if (channels.size() < 2 || same != channels.end()) {
    channels.clear();
  }
  return channels;
}

}  // namespace metamer::spectral_ref
