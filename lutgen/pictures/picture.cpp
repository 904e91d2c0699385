// SPDX-License-Identifier: Apache-2.0
#include "picture.h"

#include <OpenImageIO/parallel.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/pending_file.h"

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

Picture::Picture(const std::filesystem::path& file) : m_pixels(file.string()) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    throw InputError(file.string(), "", "", "is not there; check the path");
  }
  if (!m_pixels.read(0, 0, true, OIIO::TypeDesc::FLOAT)) {
    throw InputError(file.string(), "", "", "cannot be read: " + m_pixels.geterror());
  }
  if (m_pixels.nsubimages() > 1) {
    throw InputError(file.string(), "parts", std::to_string(m_pixels.nsubimages()),
                     "only pictures of one part are transformed; split it first");
  }
  if (m_pixels.deep()) {
    throw InputError(file.string(), "", "", "is a deep picture; flatten it first");
  }
  m_colours = colourChannels(m_pixels.spec(), file.string());
}

stage::PictureView Picture::view() const {
  const OIIO::ImageSpec& spec = m_pixels.spec();
  const std::size_t count = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height) *
                            static_cast<std::size_t>(spec.nchannels);
  return {
      {static_cast<const float*>(m_pixels.localpixels()), count}, spec.width, spec.height, spec.nchannels, m_colours};
}

void Picture::changeRow(int row, const std::function<void(std::span<float> rgba)>& body) {
  const OIIO::ImageSpec& spec = m_pixels.spec();
  const auto width = static_cast<std::size_t>(spec.width);
  const auto stride = static_cast<std::size_t>(spec.nchannels);
  auto* pixel = static_cast<float*>(m_pixels.pixeladdr(spec.x, spec.y + row % spec.height, spec.z + row / spec.height));
  std::vector<float> rgba(4 * width, 1.0F);
  std::vector<char> isFinite(width, 1);
  for (std::size_t x = 0; x < width; ++x) {
    for (std::size_t k = 0; k < 3; ++k) {
      const float value = pixel[x * stride + static_cast<std::size_t>(m_colours[k])];
      rgba[4 * x + k] = value;
      isFinite[x] = static_cast<char>(isFinite[x] != 0 && std::isfinite(value));
    }
  }
  body(rgba);
  for (std::size_t x = 0; x < width; ++x) {
    for (std::size_t k = 0; k < 3 && isFinite[x] != 0; ++k) {
      pixel[x * stride + static_cast<std::size_t>(m_colours[k])] = rgba[4 * x + k];
    }
  }
}

void Picture::forEachRow(const std::function<void(std::span<float> rgba)>& body, int threads) {
  const OIIO::ImageSpec& spec = m_pixels.spec();
  OIIO::parallel_for_chunked(
      0, static_cast<std::int64_t>(spec.height) * spec.depth, 4,
      [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
          changeRow(static_cast<int>(row), body);
        }
      },
      OIIO::parallel_options(threads));
}

std::vector<float> Picture::pixels() {
  std::vector<float> all;
  all.reserve(4 * static_cast<std::size_t>(width()) * static_cast<std::size_t>(height()));
  for (int row = 0; row < height(); ++row) {
    changeRow(row, [&](std::span<float> rgba) { all.insert(all.end(), rgba.begin(), rgba.end()); });
  }
  return all;
}

bool Picture::isSrgb() const {
  return OIIO::Strutil::iequals(m_pixels.spec().get_string_attribute("oiio:ColorSpace"), "sRGB");
}

void decodeSrgb(std::span<float> rgba) {
  for (std::size_t i = 0; i < rgba.size(); ++i) {
    if (i % 4 != 3) {
      const double value = rgba[i];
      rgba[i] = static_cast<float>(value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4));
    }
  }
}

void writePixels(const OIIO::ImageBuf& pixels, const std::filesystem::path& file, const OIIO::TypeDesc& type,
                 const std::string& field, const std::string& format) {
  spectral::PendingFile pending(file);
  if (!pixels.write(pending.path().string(), type, format)) {
    throw InputError(file.string(), field, "", "cannot be written: " + pixels.geterror());
  }
  pending.commit();
}

void Picture::write(const std::filesystem::path& file) const {
  writePixels(m_pixels, file, OIIO::TypeDesc::FLOAT, "output");
}

}  // namespace metamer::lutgen
