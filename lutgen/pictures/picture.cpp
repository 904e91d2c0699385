// SPDX-License-Identifier: Apache-2.0
#include "picture.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/library_words.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/spectral/picture_file.h"
#include "metamer/spectral/srgb_curve.h"
#include "space_names.h"

namespace metamer::lutgen {

using spectral::InputError;

std::array<int, 3> colourChannels(const OIIO::ImageSpec& spec, const std::string& file) {
  const std::array<int, 3> named = {spec.channelindex("R"), spec.channelindex("G"), spec.channelindex("B")};
  if (std::all_of(named.begin(), named.end(), [](int channel) { return channel >= 0; })) {
    return named;
  }
  const bool firstIsAlpha = spec.alpha_channel >= 0 && spec.alpha_channel < 3;
  if (spec.nchannels < 3 || firstIsAlpha) {
    throw InputError(file, "channels", std::to_string(spec.nchannels),
                     "a colour transform needs red, green and blue; convert the picture to RGB");
  }
  return {0, 1, 2};
}

namespace {

/// The file's name, once it is known to be none that its library would talk about.
std::string checked(const std::filesystem::path& file) {
  spectral::requirePictureFile(spectral::utf8(file));
  return spectral::utf8(file);
}

}  // namespace

Picture::Picture(const std::filesystem::path& file) : m_pixels(checked(file)) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    static_cast<void>(m_pixels.geterror());  // else OpenImageIO says it as well, on stdout
    throw InputError(spectral::utf8(file), "", "", "is not there; check the path");
  }
  if (!m_pixels.read(0, 0, true, OIIO::TypeDesc::FLOAT)) {
    throw InputError(spectral::utf8(file), "", "", "cannot be read: " + spectral::pictureReason(m_pixels.geterror()));
  }
  if (m_pixels.nsubimages() > 1) {
    throw InputError(spectral::utf8(file), "parts", std::to_string(m_pixels.nsubimages()),
                     "only pictures of one part are transformed; split it first");
  }
  if (m_pixels.deep()) {
    throw InputError(spectral::utf8(file), "", "", "is a deep picture; flatten it first");
  }
  m_colours = colourChannels(m_pixels.spec(), spectral::utf8(file));
}

stage::PictureView Picture::view() const {
  const OIIO::ImageSpec& spec = m_pixels.spec();
  const std::size_t count = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) *
                            static_cast<std::size_t>(spec.nchannels);
  return {
      {static_cast<const float*>(m_pixels.localpixels()), count}, spec.width, spec.height, spec.nchannels, m_colours};
}

std::vector<float> Picture::rgba() const {
  const OIIO::ImageSpec& spec = m_pixels.spec();
  const auto* pixel = static_cast<const float*>(m_pixels.localpixels());
  const auto stride = static_cast<std::size_t>(spec.nchannels);
  std::vector<float> all(4 * static_cast<std::size_t>(width()) * static_cast<std::size_t>(height()), 1.0F);
  for (std::size_t i = 0; i < all.size() / 4; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      all[4 * i + k] = pixel[i * stride + static_cast<std::size_t>(m_colours[k])];
    }
  }
  return all;
}

bool Picture::isSrgb() const {
  return spaceNamedInFile(m_pixels.spec().get_string_attribute("oiio:ColorSpace")) == "sRGB";
}

void decodeSrgb(std::span<float> rgba) {
  for (std::size_t i = 0; i < rgba.size(); ++i) {
    if (i % 4 != 3) {
      rgba[i] = static_cast<float>(spectral::linearFromSrgb(rgba[i]));
    }
  }
}

void writePixels(const OIIO::ImageBuf& pixels, const std::filesystem::path& file, const OIIO::TypeDesc& type,
                 const std::string& field, const std::string& format) {
  spectral::PendingFile pending(file);
  if (!pixels.write(spectral::utf8(pending.path()), type, format)) {
    throw InputError(spectral::utf8(file), field, "", "cannot be written: " + pixels.geterror());
  }
  pending.commit();
}

}  // namespace metamer::lutgen
