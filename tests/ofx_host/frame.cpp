// SPDX-License-Identifier: Apache-2.0
#include "frame.h"

#include <cmath>
#include <cstring>

#include "half_float.h"

namespace bare_host {
namespace {

constexpr unsigned char kGuard = 0xA5;
constexpr std::ptrdiff_t kMargin = 64;

}  // namespace

Frame::Frame(Shape shape) : m_shape(std::move(shape)) {
  const std::ptrdiff_t width = m_shape.bounds.x2 - m_shape.bounds.x1;
  const std::ptrdiff_t height = m_shape.bounds.y2 - m_shape.bounds.y1;
  m_rowBytes = width * channels() * channelBytes() + m_shape.padding;
  m_memory.assign(static_cast<std::size_t>(2 * kMargin + m_shape.misalignment + m_rowBytes * height), kGuard);
  fill([](int, int) { return Rgba{}; });
}

int Frame::channels() const {
  return m_shape.components == kOfxImageComponentRGBA ? 4 : m_shape.components == kOfxImageComponentRGB ? 3 : 1;
}

int Frame::channelBytes() const {
  return m_shape.depth == kOfxBitDepthByte ? 1 : m_shape.depth == kOfxBitDepthFloat ? 4 : 2;
}

std::ptrdiff_t Frame::offset(int x, int y) const {
  const std::ptrdiff_t row = m_shape.topDown ? m_shape.bounds.y2 - 1 - y : y - m_shape.bounds.y1;
  return kMargin + m_shape.misalignment + row * m_rowBytes +
         static_cast<std::ptrdiff_t>(x - m_shape.bounds.x1) * channels() * channelBytes();
}

void Frame::fill(const std::function<Rgba(int x, int y)>& pixels) {
  for (int y = m_shape.bounds.y1; y < m_shape.bounds.y2; ++y) {
    for (int x = m_shape.bounds.x1; x < m_shape.bounds.x2; ++x) {
      const Rgba rgba = pixels(x, y);
      unsigned char* bytes = m_memory.data() + offset(x, y);
      for (int k = 0; k < channels(); ++k, bytes += channelBytes()) {
        const float value = rgba[static_cast<std::size_t>(channels() == 1 ? 3 : k)];
        if (m_shape.depth == kOfxBitDepthFloat) {
          std::memcpy(bytes, &value, 4);
        } else if (m_shape.depth == kOfxBitDepthByte) {
          *bytes = static_cast<unsigned char>(std::lround(std::min(std::max(value, 0.0F), 1.0F) * 255));
        } else {
          const std::uint16_t code =
              m_shape.depth == kOfxBitDepthHalf
                  ? photo_host::halfFromFloat(value)
                  : static_cast<std::uint16_t>(std::lround(std::min(std::max(value, 0.0F), 1.0F) * 65535));
          std::memcpy(bytes, &code, 2);
        }
      }
    }
  }
}

Frame::Rgba Frame::at(int x, int y) const {
  Rgba rgba = {0, 0, 0, 1};
  const unsigned char* bytes = m_memory.data() + offset(x, y);
  for (int k = 0; k < channels(); ++k, bytes += channelBytes()) {
    float& value = rgba[static_cast<std::size_t>(channels() == 1 ? 3 : k)];
    if (m_shape.depth == kOfxBitDepthFloat) {
      std::memcpy(&value, bytes, 4);
    } else if (m_shape.depth == kOfxBitDepthByte) {
      value = static_cast<float>(*bytes) / 255;
    } else {
      std::uint16_t code = 0;
      std::memcpy(&code, bytes, 2);
      value = m_shape.depth == kOfxBitDepthHalf ? photo_host::floatFromHalf(code) : static_cast<float>(code) / 65535;
    }
  }
  return rgba;
}

std::string Frame::bytes(int x, int y) const {
  const auto* first = reinterpret_cast<const char*>(m_memory.data() + offset(x, y));
  return {first, first + channels() * channelBytes()};
}

bool Frame::isGuardIntact() const {
  std::vector<bool> isPixel(m_memory.size(), false);
  for (int y = m_shape.bounds.y1; y < m_shape.bounds.y2; ++y) {
    const std::ptrdiff_t row = offset(m_shape.bounds.x1, y);
    for (std::ptrdiff_t i = row; i < row + m_rowBytes - m_shape.padding; ++i) {
      isPixel[static_cast<std::size_t>(i)] = true;
    }
  }
  for (std::size_t i = 0; i < m_memory.size(); ++i) {
    if (!isPixel[i] && m_memory[i] != kGuard) {
      return false;
    }
  }
  return true;
}

Image Frame::image(const std::string& premultiplication) const {
  Image image;
  image.bounds = m_shape.bounds;
  const bool isEmpty = m_shape.bounds.x1 >= m_shape.bounds.x2 || m_shape.bounds.y1 >= m_shape.bounds.y2;
  image.data = isEmpty ? nullptr : m_memory.data() + offset(m_shape.bounds.x1, m_shape.bounds.y1);
  image.rowBytes = static_cast<int>(m_shape.topDown ? -m_rowBytes : m_rowBytes);
  image.depth = m_shape.depth;
  image.components = m_shape.components;
  image.premultiplication = premultiplication;
  return image;
}

Frame::Rgba testPixel(int x, int y) {
  // A small hash (Wellons' lowbias32) of the position, a fresh one a channel.
  std::uint32_t state = static_cast<std::uint32_t>(x) * 73856093U ^ static_cast<std::uint32_t>(y) * 19349663U;
  const auto uniform = [&state] {
    state = (state + 0x9e3779b9U);
    std::uint32_t h = state;
    h = (h ^ h >> 16U) * 0x7feb352dU;
    h = (h ^ h >> 15U) * 0x846ca68bU;
    return static_cast<float>((h ^ h >> 16U) >> 8U) / 16777216.0F;
  };
  Frame::Rgba rgba = {uniform(), uniform(), uniform(), uniform()};
  const float kind = uniform();
  if (kind < 0.2F) {
    rgba[static_cast<std::size_t>(uniform() * 3)] *= -0.3F;
  } else if (kind < 0.3F) {
    for (std::size_t k = 0; k < 3; ++k) {
      rgba[k] *= 1000;
    }
  } else if (kind < 0.35F) {
    rgba[3] = 0;
  }
  return rgba;
}

}  // namespace bare_host
