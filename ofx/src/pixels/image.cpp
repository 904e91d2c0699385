// SPDX-License-Identifier: Apache-2.0
#include "pixels/image.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace metamer::ofx {

OfxRectI intersection(const OfxRectI& a, const OfxRectI& b) {
  return {std::max(a.x1, b.x1), std::max(a.y1, b.y1), std::min(a.x2, b.x2), std::min(a.y2, b.y2)};
}

std::optional<ClipImage> ClipImage::fetch(const HostSuites& host, OfxImageClipHandle clip, double time) {
  OfxPropertySetHandle image = nullptr;
  if (clip == nullptr || host.effect->clipGetImage(clip, time, nullptr, &image) != kOfxStatOK || image == nullptr) {
    return std::nullopt;
  }
  return ClipImage(host, image);
}

ClipImage::ClipImage(const HostSuites& host, OfxPropertySetHandle image) : m_host(&host), m_image(image) {
  try {
    const PropertySet properties(host, image);
    m_pixels.bounds = properties.getRectI(kOfxImagePropBounds);
    m_pixels.rowBytes = properties.getInt(kOfxImagePropRowBytes);
    m_pixels.data = static_cast<unsigned char*>(properties.getPointer(kOfxImagePropData));
    const auto format = pixelFormat(properties.getString(kOfxImageEffectPropPixelDepth),
                                    properties.getString(kOfxImageEffectPropComponents));
    if (!format) {
      throw HostError(kOfxStatErrImageFormat, "an image of a format that was not offered");
    }
    m_pixels.format = *format;
    if (isEmpty(m_pixels.bounds)) {
      m_pixels.bounds = {};
    } else {
      const auto width = static_cast<std::ptrdiff_t>(m_pixels.bounds.x2) - m_pixels.bounds.x1;
      const bool isOneRow = m_pixels.bounds.y2 - m_pixels.bounds.y1 == 1;
      const bool rowsOverlap =
          std::abs(m_pixels.rowBytes) < width * static_cast<std::ptrdiff_t>(m_pixels.format.bytesPerPixel());
      if (m_pixels.data == nullptr || (rowsOverlap && !isOneRow)) {
        throw HostError(kOfxStatErrImageFormat, "an image without memory, or with rows shorter than its bounds");
      }
    }
    const std::string premultiplication =
        properties.findString(kOfxImageEffectPropPreMultiplication).value_or(kOfxImageUnPreMultiplied);
    m_premultiplication = premultiplication == kOfxImageOpaque          ? Premultiplication::Opaque
                          : premultiplication == kOfxImagePreMultiplied ? Premultiplication::Premultiplied
                                                                        : Premultiplication::Unpremultiplied;
    m_field = properties.findString(kOfxImagePropField).value_or(kOfxImageFieldNone);
  } catch (...) {
    host.effect->clipReleaseImage(image);
    throw;
  }
}

ClipImage::ClipImage(ClipImage&& other) noexcept
    : m_host(other.m_host),
      m_image(std::exchange(other.m_image, nullptr)),
      m_pixels(other.m_pixels),
      m_premultiplication(other.m_premultiplication),
      m_field(std::move(other.m_field)) {}

ClipImage::~ClipImage() {
  if (m_image != nullptr) {
    m_host->effect->clipReleaseImage(m_image);
  }
}

}  // namespace metamer::ofx
