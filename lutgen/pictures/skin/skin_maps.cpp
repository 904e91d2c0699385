// SPDX-License-Identifier: Apache-2.0
#include "skin/skin_maps.h"

#include <algorithm>
#include <cmath>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"

namespace metamer::lutgen {
namespace {

using spectral::InputError;

constexpr const char* kIlluminant = "metamer:skinIlluminant";
constexpr const char* kObserver = "metamer:skinObserver";
constexpr const char* kChannels = "metamer:skinChannels";
constexpr const char* kPrefix = "skin.";

int channelNamed(const PartFacts& part, const std::string& name) {
  const auto found = std::find_if(part.channels.begin(), part.channels.end(),
                                  [&](const ChannelFacts& channel) { return channel.name == name; });
  return found == part.channels.end() ? -1 : static_cast<int>(found - part.channels.begin());
}

bool hasMaps(const PartFacts& part) {
  return std::any_of(part.channels.begin(), part.channels.end(),
                     [](const ChannelFacts& channel) { return channel.name.rfind(kPrefix, 0) == 0; });
}

}  // namespace

bool hasSkinMaps(const AnyPicture& picture) {
  const std::vector<PartFacts> facts = picture.facts();
  return std::any_of(facts.begin(), facts.end(), hasMaps);
}

SkinMapsPlace findSkinMaps(const AnyPicture& picture, const std::string& file) {
  const std::vector<PartFacts> facts = picture.facts();
  const auto part = std::find_if(facts.begin(), facts.end(), hasMaps);
  if (part == facts.end()) {
    throw InputError(file, "channels", "", "are no maps of skin: make some with lutgen skin estimate");
  }
  if (std::count_if(facts.begin(), facts.end(), hasMaps) > 1) {
    throw InputError(file, "parts", "", "have maps of skin more than once; give a file with one");
  }
  SkinMapsPlace place{static_cast<int>(part - facts.begin()), {}};
  std::vector<std::string> missing;
  for (const char* name : kSkinChannels) {
    const int channel = channelNamed(*part, name);
    if (channel < 0) {
      missing.emplace_back(name);
    } else if (part->isDeep || !part->channels[static_cast<std::size_t>(channel)].isColourType) {
      throw InputError(file, "channel", name, "is deep or holds whole numbers; write half or float");
    }
    place.channels.push_back(channel);
  }
  if (!missing.empty()) {
    throw InputError(
        file, "channels", spectral::joined(missing),
        missing.size() == 1 ? "is missing; estimate the maps again" : "are missing; estimate the maps again");
  }
  return place;
}

SkinMapsHeader skinMapsHeader(const AnyPicture& picture, int part) {
  SkinMapsHeader header;
  header.capture = SkinCapture{picture.text(part, kIlluminant), picture.text(part, kObserver)};
  const std::string names = picture.text(part, kChannels);
  for (std::size_t begin = 0; begin < names.size();) {
    const std::size_t end = std::min(names.find(',', begin), names.size());
    header.channels.push_back(names.substr(begin, end - begin));
    begin = end + 1;
  }
  if (header.channels.size() != 3) {
    header.channels = {"R", "G", "B"};
  }
  return header;
}

void setSkinMapsHeader(AnyPicture& picture, int part, const SkinMapsHeader& header) {
  picture.setText(part, kIlluminant, header.capture.illuminant);
  picture.setText(part, kObserver, header.capture.observer);
  std::string names;
  for (const std::string& name : header.channels) {
    names += (names.empty() ? "" : ",") + name;
  }
  picture.setText(part, kChannels, names);
}

std::vector<skin::SkinPixel> skinPixels(const AnyPicture& picture, const SkinMapsPlace& place) {
  const std::vector<float> numbers = picture.values(place.part, place.channels);
  std::vector<skin::SkinPixel> pixels(numbers.size() / kSkinChannels.size());
  const float* from = numbers.data();
  for (skin::SkinPixel& pixel : pixels) {
    std::copy_n(from, 5, pixel.skin.begin());
    pixel.gain = from[5];
    std::copy_n(from + 6, 3, pixel.residual.begin());
    from += kSkinChannels.size();
  }
  return pixels;
}

std::vector<float> skinNumbers(const std::vector<skin::SkinPixel>& pixels) {
  std::vector<float> numbers(pixels.size() * kSkinChannels.size());
  float* to = numbers.data();
  for (const skin::SkinPixel& pixel : pixels) {
    to = std::copy(pixel.skin.begin(), pixel.skin.end(), to);
    *to++ = pixel.gain;
    to = std::copy(pixel.residual.begin(), pixel.residual.end(), to);
  }
  return numbers;
}

void changeColours(std::vector<float>& rgb, const PixelFunction& function) {
  if (!function) {
    return;
  }
  std::vector<float> rgba(rgb.size() / 3 * 4, 1.0F);
  for (std::size_t i = 0; i < rgb.size() / 3; ++i) {
    std::copy_n(&rgb[3 * i], 3, &rgba[4 * i]);
  }
  function(rgba);
  for (std::size_t i = 0; i < rgb.size() / 3; ++i) {
    if (std::isfinite(rgb[3 * i]) && std::isfinite(rgb[3 * i + 1]) && std::isfinite(rgb[3 * i + 2])) {
      std::copy_n(&rgba[4 * i], 3, &rgb[3 * i]);
    }
  }
}

}  // namespace metamer::lutgen
