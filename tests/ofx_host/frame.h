// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "bare_host.h"

namespace bare_host {

/// Pixels in memory in any of the shapes that hosts use, with guarded memory around and between the rows.
class Frame {
 public:
  struct Shape {
    OfxRectI bounds{};
    std::string depth = kOfxBitDepthFloat;
    std::string components = kOfxImageComponentRGBA;
    int padding = 0;       ///< bytes between rows
    bool topDown = false;  ///< negative row bytes
    int misalignment = 0;  ///< bytes before the first pixel
  };
  using Rgba = std::array<float, 4>;

  explicit Frame(Shape shape);

  /// Fills it from a function of position.
  void fill(const std::function<Rgba(int x, int y)>& pixels);
  Rgba at(int x, int y) const;
  /// The pixel's own bytes, for comparisons that know no rounding.
  std::string bytes(int x, int y) const;
  /// Whether nothing but pixels has been written.
  bool isGuardIntact() const;

  Image image(const std::string& premultiplication = kOfxImageUnPreMultiplied) const;
  const Shape& shape() const { return m_shape; }

 private:
  std::ptrdiff_t offset(int x, int y) const;
  int channels() const;
  int channelBytes() const;

  Shape m_shape;
  std::ptrdiff_t m_rowBytes = 0;  ///< positive
  mutable std::vector<unsigned char> m_memory;
};

/// A repeatable picture of every sort of colour, alpha included: natural ones, saturated ones, beyond gamut, dark.
Frame::Rgba testPixel(int x, int y);

}  // namespace bare_host
