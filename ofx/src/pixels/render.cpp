// SPDX-License-Identifier: Apache-2.0
#include "pixels/render.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <utility>
#include <vector>

#include "host/threads.h"

namespace metamer::ofx {
namespace {

/// Pixels that are worked on at a time: they stay in the nearest cache.
constexpr int kChunk = 512;
/// Pixels that a worker takes at a time, about: often enough to notice an abort, seldom enough to cost nothing.
constexpr int kPixelsPerTurn = 1 << 15;
using Chunk = std::array<float, 4 * std::size_t{kChunk}>;

bool isFinite(const float* rgb) {
  return std::isfinite(rgb[0]) && std::isfinite(rgb[1]) && std::isfinite(rgb[2]);
}

/// Pixels [x, x + count) of a row as float RGBA; 0 outside the bounds.
void readRow(const PixelView& image, int x, int y, int count, float* rgba) {
  std::fill_n(rgba, 4 * static_cast<std::size_t>(count), 0.0F);
  if (image.data == nullptr || !image.containsRow(y)) {
    return;
  }
  const int begin = std::max(x, image.bounds.x1);
  const int end = std::min(x + count, image.bounds.x2);
  if (begin < end) {
    readPixels(image.format, image.at(begin, y), static_cast<std::size_t>(end - begin),
               rgba + 4 * static_cast<std::ptrdiff_t>(begin - x));
  }
}

/// Applies a transform that is not homogeneous to premultiplied pixels: on the colours without their alpha. Pixels of
/// alpha 0 carry no colour of their own and stay, and so does what division takes beyond the range of float.
void applyUnpremultiplied(const PixelTransform& transform, const float* source, float* destination, int count) {
  const auto pixels = static_cast<std::size_t>(count);
  Chunk colours;
  for (std::size_t i = 0; i < pixels; ++i) {
    const float alpha = source[4 * i + 3];
    for (std::size_t k = 0; k < 3; ++k) {
      colours[4 * i + k] = alpha > 0.0F ? source[4 * i + k] / alpha : 0.0F;
    }
    colours[4 * i + 3] = alpha;
  }
  const std::span<float> used(colours.data(), 4 * pixels);
  transform.apply(used, used);
  for (std::size_t i = 0; i < pixels; ++i) {
    const float* colour = colours.data() + 4 * i;
    const float alpha = source[4 * i + 3];
    const std::array<float, 3> result = {colour[0] * alpha, colour[1] * alpha, colour[2] * alpha};
    const bool keep = !(alpha > 0.0F) || !isFinite(source + 4 * i) || !isFinite(result.data());
    for (std::size_t k = 0; k < 3; ++k) {
      destination[4 * i + k] = keep ? source[4 * i + k] : result[k];
    }
    destination[4 * i + 3] = alpha;
  }
}

class WindowRenderer {
 public:
  WindowRenderer(const RenderJob& job, const OfxRectI& window)
      : m_job(job),
        m_window(window),
        m_mix(static_cast<float>(std::clamp(job.mix, 0.0, 1.0))),
        m_isWhole(m_mix >= 1.0F && !job.hasMask),
        m_divides(job.transform != nullptr && !job.transform->isHomogeneous() &&
                  job.premultiplication == Premultiplication::Premultiplied) {
    const PixelFormat plain{Depth::Float, Components::Rgba};
    m_isDirect = m_isWhole && !m_divides && job.source.format == plain && job.output.format == plain &&
                 isAligned(job.source) && isAligned(job.output);
  }

  void row(int y) const {
    // From memory to memory a row goes whole: the longer the span, the further the kernel asks for memory ahead.
    const int step =
        m_isDirect && isInside(m_window.x1, y, m_window.x2 - m_window.x1) ? m_window.x2 - m_window.x1 : kChunk;
    for (int x = m_window.x1; x < m_window.x2; x += step) {
      chunk(x, y, std::min(step, m_window.x2 - x));
    }
  }

 private:
  static bool isAligned(const PixelView& image) {
    constexpr std::ptrdiff_t kAlignment = alignof(float);
    return reinterpret_cast<std::uintptr_t>(image.data) % kAlignment == 0 && image.rowBytes % kAlignment == 0;
  }

  bool isInside(int x, int y, int count) const {
    const PixelView& source = m_job.source;
    return source.data != nullptr && source.containsRow(y) && x >= source.bounds.x1 && x + count <= source.bounds.x2;
  }

  /// @param count  at most kChunk, but where the pixels go straight from the host's memory to the host's
  void chunk(int x, int y, int count) const {
    const PixelView& source = m_job.source;
    const PixelView& output = m_job.output;
    const std::size_t floats = 4 * static_cast<std::size_t>(count);
    const bool inside = isInside(x, y, count);
    if (inside && m_job.transform == nullptr && m_isWhole && source.format == output.format) {
      // Copied code for code.
      std::memmove(output.at(x, y), source.at(x, y), static_cast<std::size_t>(count) * source.format.bytesPerPixel());
      return;
    }
    if (m_isDirect && inside) {
      const std::span<const float> from(reinterpret_cast<const float*>(source.at(x, y)), floats);
      const std::span<float> to(reinterpret_cast<float*>(output.at(x, y)), floats);
      transform(from.data(), to.data(), count);
      return;
    }
    Chunk pixels;
    readRow(source, x, y, count, pixels.data());
    if (m_isWhole) {
      transform(pixels.data(), pixels.data(), count);
    } else {
      Chunk result;
      transform(pixels.data(), result.data(), count);
      blend(x, y, count, pixels.data(), result.data());
    }
    writePixels(output.format, pixels.data(), static_cast<std::size_t>(count), output.at(x, y));
  }

  void transform(const float* from, float* to, int count) const {
    const std::size_t floats = 4 * static_cast<std::size_t>(count);
    if (m_job.transform == nullptr) {
      std::copy_n(from, from == to ? 0 : floats, to);
    } else if (m_divides) {
      applyUnpremultiplied(*m_job.transform, from, to, count);
    } else {
      m_job.transform->apply({from, floats}, {to, floats});
    }
  }

  /// pixels += weight (result - pixels); whole weights take one or the other as they are.
  void blend(int x, int y, int count, float* pixels, const float* result) const {
    Chunk mask;
    if (m_job.hasMask) {
      readRow(m_job.mask, x, y, count, mask.data());
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      float weight = m_mix;
      if (m_job.hasMask) {
        const float value = mask[4 * i + 3];
        // The comparisons also send NaN to 0.
        weight *= value > 0.0F ? (value < 1.0F ? value : 1.0F) : 0.0F;
      }
      for (std::size_t k = 0; k < 3 && weight > 0.0F; ++k) {
        float& pixel = pixels[4 * i + k];
        const float changed = result[4 * i + k];
        pixel = weight >= 1.0F ? changed : (1.0F - weight) * pixel + weight * changed;
      }
    }
  }

  const RenderJob& m_job;
  OfxRectI m_window;
  float m_mix;
  bool m_isWhole;   ///< mix 1 everywhere
  bool m_divides;   ///< alpha is divided out and multiplied back
  bool m_isDirect;  ///< from the host's memory to the host's memory
};

/// Address that a pixel has, or would have where it is outside the bounds.
std::uintptr_t address(const PixelView& image, int x, int y) {
  const std::ptrdiff_t offset =
      (static_cast<std::ptrdiff_t>(y) - image.bounds.y1) * image.rowBytes +
      (static_cast<std::ptrdiff_t>(x) - image.bounds.x1) * static_cast<std::ptrdiff_t>(image.format.bytesPerPixel());
  return reinterpret_cast<std::uintptr_t>(image.data) + static_cast<std::uintptr_t>(offset);
}

/// The addresses an image covers.
std::pair<std::uintptr_t, std::uintptr_t> extent(const PixelView& image) {
  const std::uintptr_t low = address(image, image.bounds.x1, image.bounds.y1);
  const std::uintptr_t high = address(image, image.bounds.x1, image.bounds.y2 - 1);
  const std::size_t row = static_cast<std::size_t>(image.bounds.x2 - image.bounds.x1) * image.format.bytesPerPixel();
  return {std::min(low, high), std::max(low, high) + row};
}

/// Whether a row written could be read afterwards by another: memory shared, but not pixel on pixel.
bool interferes(const PixelView& input, const PixelView& output) {
  if (input.data == nullptr || isEmpty(input.bounds)) {
    return false;
  }
  const auto [inputBegin, inputEnd] = extent(input);
  const auto [outputBegin, outputEnd] = extent(output);
  if (inputEnd <= outputBegin || outputEnd <= inputBegin) {
    return false;
  }
  const bool isSamePixels = input.format == output.format && input.rowBytes == output.rowBytes &&
                            address(input, 0, 0) == address(output, 0, 0);
  return !isSamePixels;
}

/// A private copy of what the window needs of an image.
PixelView copyOf(const PixelView& image, const OfxRectI& window, std::vector<unsigned char>& memory) {
  PixelView copy = image;
  copy.bounds = intersection(image.bounds, window);
  if (isEmpty(copy.bounds)) {
    copy.data = nullptr;
    return copy;
  }
  const std::size_t row = static_cast<std::size_t>(copy.bounds.x2 - copy.bounds.x1) * image.format.bytesPerPixel();
  memory.resize(row * static_cast<std::size_t>(copy.bounds.y2 - copy.bounds.y1));
  copy.data = memory.data();
  copy.rowBytes = static_cast<std::ptrdiff_t>(row);
  for (int y = copy.bounds.y1; y < copy.bounds.y2; ++y) {
    std::memcpy(copy.at(copy.bounds.x1, y), image.at(copy.bounds.x1, y), row);
  }
  return copy;
}

}  // namespace

int firstRow(FieldToRender field, const OfxRectI& window) {
  const bool isOther = field != FieldToRender::Whole && (window.y1 % 2 != 0) != (field == FieldToRender::Upper);
  return isOther ? window.y1 + 1 : window.y1;
}

void render(const HostSuites& host, const RenderJob& given, const std::function<bool()>& isAborted) {
  const OfxRectI window = given.output.data == nullptr ? OfxRectI{} : intersection(given.window, given.output.bounds);
  if (isEmpty(window) || isAborted()) {
    return;
  }
  RenderJob job = given;
  std::vector<unsigned char> sourceCopy;
  std::vector<unsigned char> maskCopy;
  if (interferes(job.source, job.output)) {
    job.source = copyOf(job.source, window, sourceCopy);
  }
  if (job.hasMask && interferes(job.mask, job.output)) {
    job.mask = copyOf(job.mask, window, maskCopy);
  }
  const int step = rowStep(job.field);
  const int first = firstRow(job.field, window);
  const int rows = first < window.y2 ? (window.y2 - first + step - 1) / step : 0;
  const int rowsPerTurn = std::max(1, kPixelsPerTurn / (window.x2 - window.x1));
  const int turns = (rows + rowsPerTurn - 1) / rowsPerTurn;

  const WindowRenderer renderer(job, window);
  std::atomic<int> nextTurn = 0;
  std::atomic<bool> aborted = false;
  runWorkers(host, turns, [&](int worker) {
    for (int turn = nextTurn++; turn < turns && !aborted; turn = nextTurn++) {
      if (worker == 0 && isAborted()) {
        aborted = true;
        return;
      }
      const int end = std::min(rows, (turn + 1) * rowsPerTurn);
      for (int row = turn * rowsPerTurn; row < end; ++row) {
        renderer.row(first + row * step);
      }
    }
  });
}

}  // namespace metamer::ofx
