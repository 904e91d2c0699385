// SPDX-License-Identifier: Apache-2.0
#include "stage_pictures/environment_picture.h"

#include <algorithm>
#include <cmath>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/library_words.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/picture_file.h"
#include "picture.h"

namespace metamer::lutgen {
namespace {

using spectral::InputError;

constexpr int kRowsAtOnce = 64;

}  // namespace

EnvironmentPicture::EnvironmentPicture(std::filesystem::path file) : m_file(std::move(file)) {
  std::error_code ignored;
  if (!std::filesystem::exists(m_file, ignored)) {
    throw InputError(spectral::utf8(m_file), "", "", "is not there; check the path");
  }
  spectral::requirePictureFile(spectral::utf8(m_file));
  m_input = OIIO::ImageInput::open(spectral::utf8(m_file));
  if (!m_input) {
    throw InputError(spectral::utf8(m_file), "", "", "cannot be read: " + spectral::pictureReason(OIIO::geterror()));
  }
  const OIIO::ImageSpec& spec = m_input->spec();
  m_colours = colourChannels(spec, spectral::utf8(m_file));
  m_layout = {spec.width, spec.height};
  if (spec.width != 2 * spec.height) {
    throw InputError(spectral::utf8(m_file), "size", std::to_string(spec.width) + " x " + std::to_string(spec.height),
                     "must be twice as wide as high; give a whole lat-long environment");
  }
  if (spec.tile_width > 0) {
    m_tiles = std::make_unique<OIIO::ImageBuf>(spectral::utf8(m_file));
  }
}

void EnvironmentPicture::read(int first, int count, Eigen::Matrix3Xf& rgb) {
  const OIIO::ImageSpec& spec = m_input->spec();
  const auto channels = static_cast<std::size_t>(spec.nchannels);
  const std::size_t pixels = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(count);
  m_buffer.resize(pixels * channels);
  const int top = spec.y + first;
  const OIIO::ROI rows(spec.x, spec.x + spec.width, top, top + count, 0, 1, 0, spec.nchannels);
  const bool isRead = m_tiles ? m_tiles->get_pixels(rows, OIIO::TypeDesc::FLOAT, m_buffer.data())
                              : m_input->read_scanlines(0, 0, top, top + count, 0, 0, spec.nchannels,
                                                        OIIO::TypeDesc::FLOAT, m_buffer.data());
  if (!isRead) {
    throw InputError(spectral::utf8(m_file), "rows", std::to_string(first),
                     "cannot be read: " + spectral::pictureReason(m_tiles ? m_tiles->geterror() : m_input->geterror()));
  }
  rgb.resize(3, static_cast<Eigen::Index>(pixels));
  for (std::size_t i = 0; i < pixels; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      rgb(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) =
          m_buffer[i * channels + static_cast<std::size_t>(m_colours[k])];
    }
  }
}

Eigen::Vector3d diffuseLight(const std::filesystem::path& file, const Eigen::Vector3d& facing) {
  EnvironmentPicture picture(file);
  const stage::LatLong layout = picture.layout();
  stage::DiffuseConvolution light(layout, facing);
  Eigen::Matrix3Xf rgb;
  for (int first = 0; first < layout.height; first += kRowsAtOnce) {
    const int count = std::min(kRowsAtOnce, layout.height - first);
    picture.read(first, count, rgb);
    rgb = rgb.unaryExpr([](float v) { return std::isfinite(v) ? std::max(v, 0.0F) : 0.0F; });
    for (int row = 0; row < count; ++row) {
      light.addRow(first + row, rgb.middleCols(static_cast<Eigen::Index>(row) * layout.width, layout.width));
    }
  }
  return light.value();
}

}  // namespace metamer::lutgen
