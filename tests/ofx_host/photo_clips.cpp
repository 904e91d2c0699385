// SPDX-License-Identifier: Apache-2.0
#include "photo_clips.h"

#include <cmath>
#include <cstring>

#include "half_float.h"

namespace photo_host {
namespace {

int channels(const ClipKind& kind) {
  return kind.components == kOfxImageComponentRGBA ? 4 : kind.components == kOfxImageComponentRGB ? 3 : 1;
}

int channelBytes(const ClipKind& kind) {
  return kind.depth == kOfxBitDepthByte ? 1 : kind.depth == kOfxBitDepthFloat ? 4 : 2;
}

void put(const ClipKind& kind, float value, unsigned char* bytes) {
  if (kind.depth == kOfxBitDepthFloat) {
    std::memcpy(bytes, &value, 4);
  } else if (kind.depth == kOfxBitDepthHalf) {
    const std::uint16_t code = halfFromFloat(value);
    std::memcpy(bytes, &code, 2);
  } else if (kind.depth == kOfxBitDepthShort) {
    const auto code = static_cast<std::uint16_t>(std::lround(value * 65535));
    std::memcpy(bytes, &code, 2);
  } else {
    *bytes = static_cast<unsigned char>(std::lround(value * 255));
  }
}

float taken(const ClipKind& kind, const unsigned char* bytes) {
  if (kind.depth == kOfxBitDepthFloat) {
    float value = 0;
    std::memcpy(&value, bytes, 4);
    return value;
  }
  if (kind.depth == kOfxBitDepthByte) {
    return static_cast<float>(*bytes) / 255;
  }
  std::uint16_t code = 0;
  std::memcpy(&code, bytes, 2);
  return kind.depth == kOfxBitDepthHalf ? floatFromHalf(code) : static_cast<float>(code) / 65535;
}

}  // namespace

Store::Store(const Picture& picture, const ClipKind& kind)
    : m_x(picture.x), m_y(picture.y), m_width(picture.width), m_height(picture.height), m_kind(kind) {
  m_bytes.resize(static_cast<std::size_t>(rowBytes()) * static_cast<std::size_t>(m_height));
  const int count = channels(kind);
  unsigned char* bytes = m_bytes.data();
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
    for (int k = 0; k < count; ++k, bytes += channelBytes(kind)) {
      put(kind, picture.rgba[i + static_cast<std::size_t>(count == 1 ? 3 : k)], bytes);
    }
  }
}

Picture Store::picture() const {
  Picture picture{m_x, m_y, m_width, m_height, {}};
  const int count = channels(m_kind);
  const unsigned char* bytes = m_bytes.data();
  for (int i = 0; i < m_width * m_height; ++i) {
    float pixel[4] = {0, 0, 0, 1};
    for (int k = 0; k < count; ++k, bytes += channelBytes(m_kind)) {
      pixel[count == 1 ? 3 : k] = taken(m_kind, bytes);
    }
    picture.rgba.insert(picture.rgba.end(), pixel, pixel + 4);
  }
  return picture;
}

OfxRectI Store::bounds() const {
  return {m_x, m_y, m_x + m_width, m_y + m_height};
}

int Store::rowBytes() const {
  return m_width * channels(m_kind) * channelBytes(m_kind);
}

Clip::Clip(OFX::Host::ImageEffect::Instance* effect, OFX::Host::ImageEffect::ClipDescriptor& descriptor, ClipKind kind)
    : ClipInstance(effect, descriptor), m_kind(std::move(kind)) {}

void Clip::show(const Picture& picture) {
  m_store = Store(picture, m_kind);
}

void Clip::getFrameRange(double& start, double& end) const {
  start = 0;
  end = 1e6;
}

const std::string& Clip::getFieldOrder() const {
  static const std::string none(kOfxImageFieldNone);
  return none;
}

OfxRectD Clip::getRegionOfDefinition(OfxTime) const {
  const OfxRectI bounds = m_store.bounds();
  return {double(bounds.x1), double(bounds.y1), double(bounds.x2), double(bounds.y2)};
}

OFX::Host::ImageEffect::Image* Clip::getImage(OfxTime, const OfxRectD*) {
  if (m_store.isEmpty()) {
    return nullptr;
  }
  const OfxRectI bounds = m_store.bounds();
  auto* image = new OFX::Host::ImageEffect::Image(*this, 1, 1, m_store.data(), bounds, bounds, m_store.rowBytes(),
                                                  kOfxImageFieldNone, getName());
  image->setStringProperty(kOfxImageEffectPropPixelDepth, m_kind.depth);
  image->setStringProperty(kOfxImageEffectPropComponents, m_kind.components);
  image->setStringProperty(kOfxImageEffectPropPreMultiplication, m_kind.premultiplication);
  return image;
}

}  // namespace photo_host
