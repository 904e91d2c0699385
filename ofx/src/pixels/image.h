// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "host/host.h"
#include "host/property_set.h"
#include "pixels/pixel_format.h"

namespace metamer::ofx {

enum class Premultiplication { Opaque, Premultiplied, Unpremultiplied };

/// Pixels of one image in memory. Coordinates are the host's pixel coordinates at the render scale; `rowBytes` may be
/// negative and may include padding; `data` is the pixel (bounds.x1, bounds.y1).
struct PixelView {
  unsigned char* data = nullptr;
  OfxRectI bounds{};
  std::ptrdiff_t rowBytes = 0;
  PixelFormat format;

  /// Address of a pixel inside the bounds.
  unsigned char* at(int x, int y) const {
    return data + static_cast<std::ptrdiff_t>(y - bounds.y1) * rowBytes +
           static_cast<std::ptrdiff_t>(x - bounds.x1) * static_cast<std::ptrdiff_t>(format.bytesPerPixel());
  }
  bool containsRow(int y) const { return y >= bounds.y1 && y < bounds.y2 && bounds.x1 < bounds.x2; }
};

OfxRectI intersection(const OfxRectI& a, const OfxRectI& b);
inline bool isEmpty(const OfxRectI& r) {
  return r.x1 >= r.x2 || r.y1 >= r.y2;
}

/// An image fetched from a clip, given back when it goes. Moveable.
class ClipImage {
 public:
  /// Nothing where the clip has no image at that time (not connected, outside its range).
  /// @throws HostError kOfxStatErrImageFormat for a depth or components that the plug-in does not declare, or memory
  ///         that is not there
  static std::optional<ClipImage> fetch(const HostSuites& host, OfxImageClipHandle clip, double time);

  ClipImage(ClipImage&& other) noexcept;
  ClipImage& operator=(ClipImage&&) = delete;
  ~ClipImage();

  const PixelView& pixels() const { return m_pixels; }
  Premultiplication premultiplication() const { return m_premultiplication; }
  /// kOfxImageFieldNone, Both, Lower or Upper.
  const std::string& field() const { return m_field; }

 private:
  ClipImage(const HostSuites& host, OfxPropertySetHandle image);

  const HostSuites* m_host;
  OfxPropertySetHandle m_image;
  PixelView m_pixels;
  Premultiplication m_premultiplication = Premultiplication::Unpremultiplied;
  std::string m_field;
};

}  // namespace metamer::ofx
