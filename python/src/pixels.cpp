// SPDX-License-Identifier: Apache-2.0
#include "pixels.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "arrays.h"

namespace metamer::python {
namespace {

/// Pixels that are worked on together where they have to be copied first.
constexpr std::size_t kChunk = 1024;

/// Where pixels lie, in steps of numbers.
struct Layout {
  std::vector<std::int64_t> shape;
  std::vector<std::int64_t> strides;
  bool operator==(const Layout&) const = default;

  std::size_t channels() const { return static_cast<std::size_t>(shape.back()); }
  std::size_t pixelCount() const {
    std::size_t count = 1;
    for (std::size_t axis = 0; axis + 1 < shape.size(); ++axis) {
      count *= static_cast<std::size_t>(shape[axis]);
    }
    return count;
  }
  bool isContiguous() const {
    std::int64_t expected = 1;
    for (std::size_t axis = shape.size(); axis-- > 0;) {
      if (shape[axis] != 1 && strides[axis] != expected) {
        return false;
      }
      expected *= shape[axis];
    }
    return true;
  }
};

template <typename Array>
Layout layoutOf(const Array& array) {
  Layout layout{{array.shape_ptr(), array.shape_ptr() + array.ndim()},
                {array.stride_ptr(), array.stride_ptr() + array.ndim()}};
  const bool isPixels = !layout.shape.empty() && (layout.shape.back() == 3 || layout.shape.back() == 4);
  if (!isPixels) {
    std::string shape;
    for (const std::int64_t length : layout.shape) {
      shape += (shape.empty() ? "" : ", ") + std::to_string(length);
    }
    throw nb::value_error(("pixels: shape (" + shape + "): the last axis must be RGB (3) or RGBA (4)").c_str());
  }
  return layout;
}

/// Goes from pixel to pixel in C order.
template <typename Number>
class PixelWalk {
 public:
  PixelWalk(Number* first, const Layout& layout)
      : m_pixel(first), m_layout(&layout), m_index(layout.shape.size() - 1, 0) {}

  /// The pixel's first number; then steps on.
  Number* next() {
    Number* const here = m_pixel;
    for (std::size_t axis = m_index.size(); axis-- > 0;) {
      m_pixel += m_layout->strides[axis];
      if (++m_index[axis] < m_layout->shape[axis]) {
        break;
      }
      m_pixel -= m_layout->strides[axis] * m_layout->shape[axis];
      m_index[axis] = 0;
    }
    return here;
  }
  std::int64_t channelStride() const { return m_layout->strides.back(); }

 private:
  Number* m_pixel;
  const Layout* m_layout;
  std::vector<std::int64_t> m_index;
};

/// First and last byte of an array.
template <typename Number>
std::pair<std::uintptr_t, std::uintptr_t> extent(const Number* data, const Layout& layout) {
  std::int64_t lowest = 0;
  std::int64_t highest = 1;
  for (std::size_t axis = 0; axis < layout.shape.size(); ++axis) {
    const std::int64_t reach = layout.strides[axis] * (layout.shape[axis] - 1);
    (reach < 0 ? lowest : highest) += reach;
  }
  const auto size = static_cast<std::int64_t>(sizeof(Number));
  const auto base = static_cast<std::int64_t>(reinterpret_cast<std::uintptr_t>(data));
  return {static_cast<std::uintptr_t>(base + lowest * size), static_cast<std::uintptr_t>(base + highest * size)};
}

void run(const PixelFunction& function, const float* source, const Layout& from, float* destination, const Layout& to) {
  const std::size_t count = from.pixelCount();
  const std::size_t channels = from.channels();
  if (channels == 4 && from.isContiguous() && to.isContiguous()) {
    function.rgba({source, 4 * count}, {destination, 4 * count});
    return;
  }
  std::array<float, 4 * kChunk> rgba;
  PixelWalk<const float> in(source, from);
  PixelWalk<float> out(destination, to);
  for (std::size_t done = 0; done < count; done += kChunk) {
    const std::size_t pixels = std::min(kChunk, count - done);
    for (std::size_t i = 0; i < pixels; ++i) {
      const float* const pixel = in.next();
      rgba[4 * i + 3] = 1.0F;
      for (std::size_t k = 0; k < channels; ++k) {
        rgba[4 * i + k] = pixel[static_cast<std::int64_t>(k) * in.channelStride()];
      }
    }
    const std::span<float> chunk(rgba.data(), 4 * pixels);
    function.rgba(chunk, chunk);
    for (std::size_t i = 0; i < pixels; ++i) {
      float* const pixel = out.next();
      for (std::size_t k = 0; k < channels; ++k) {
        pixel[static_cast<std::int64_t>(k) * out.channelStride()] = rgba[4 * i + k];
      }
    }
  }
}

void run(const PixelFunction& function, const double* source, const Layout& from, double* destination,
         const Layout& to) {
  PixelWalk<const double> in(source, from);
  PixelWalk<double> out(destination, to);
  const std::int64_t inStep = in.channelStride();
  const std::int64_t outStep = out.channelStride();
  const std::size_t count = from.pixelCount();
  std::vector<Eigen::Vector3d> colours(std::min(kChunk, count));
  std::vector<double> alphas(colours.size());
  for (std::size_t done = 0; done < count; done += kChunk) {
    const std::size_t pixels = std::min(kChunk, count - done);
    for (std::size_t i = 0; i < pixels; ++i) {
      const double* const pixel = in.next();
      colours[i] = {pixel[0], pixel[inStep], pixel[2 * inStep]};
      alphas[i] = from.channels() == 4 ? pixel[3 * inStep] : 1.0;
    }
    function.colours(std::span(colours).first(pixels));
    for (std::size_t i = 0; i < pixels; ++i) {
      double* const result = out.next();
      for (std::int64_t k = 0; k < 3; ++k) {
        result[k * outStep] = colours[i][k];
      }
      if (from.channels() == 4) {
        result[3 * outStep] = alphas[i];
      }
    }
  }
}

template <typename Number>
nb::object runOverNew(const PixelFunction& function, const Number* data, const Layout& from) {
  Layout to = from;
  std::int64_t size = 1;
  for (std::size_t axis = to.shape.size(); axis-- > 0;) {
    to.strides[axis] = size;
    size *= to.shape[axis];
  }
  auto memory = std::make_unique<Number[]>(static_cast<std::size_t>(size));
  {
    const nb::gil_scoped_release released;
    run(function, data, from, memory.get(), to);
  }
  Number* const result = memory.release();
  const nb::capsule owner(result, [](void* pointer) noexcept { delete[] static_cast<Number*>(pointer); });
  const std::vector<std::size_t> shape(to.shape.begin(), to.shape.end());
  return nb::cast(nb::ndarray<nb::numpy, Number>(result, shape.size(), shape.data(), owner));
}

template <typename Number>
nb::object runOver(const PixelFunction& function, const Pixels<Number>& pixels, const nb::object& out) {
  const Layout from = layoutOf(pixels);
  if (out.is_none()) {
    return runOverNew(function, pixels.data(), from);
  }
  nb::ndarray<Number, nb::device::cpu> result;
  if (!nb::try_cast(out, result, false)) {
    const char* const type = sizeof(Number) == sizeof(float) ? "float32" : "float64";
    throw nb::value_error((std::string("out: must be a writable array of ") + type + ", as pixels are").c_str());
  }
  const Layout to = layoutOf(result);
  if (to.shape != from.shape) {
    throw nb::value_error("out: must have the shape of pixels");
  }
  const auto [first, last] = extent(pixels.data(), from);
  const auto [outFirst, outLast] = extent(static_cast<const Number*>(result.data()), to);
  const bool isSame = pixels.data() == result.data() && to == from;
  if (!isSame && from.pixelCount() > 0 && first < outLast && outFirst < last) {
    throw nb::value_error("out: lies over pixels; give pixels itself, or an array of its own");
  }
  const nb::gil_scoped_release released;
  run(function, pixels.data(), from, result.data(), to);
  return out;
}

}  // namespace

nb::object runOverPixels(const PixelFunction& function, const Pixels<float>& pixels, const nb::object& out) {
  return runOver(function, pixels, out);
}

nb::object runOverNumbers(const PixelFunction& function, const nb::object& numbers, const nb::object& out) {
  Pixels<double> pixels;
  if (nb::try_cast(numbers, pixels, false)) {
    return runOver(function, pixels, out);
  }
  if (nb::hasattr(numbers, "dtype")) {
    const nb::object dtype = numbers.attr("dtype");
    const std::string type = nb::str(dtype).c_str();
    throw nb::value_error(("pixels: type " + type + ": must be float32 or float64, scene-linear, in this machine's " +
                           "memory and byte order; convert them first")
                              .c_str());
  }
  if (!out.is_none()) {
    throw nb::value_error("out: needs pixels that are an array of float32 or float64");
  }
  return runOver(function, Pixels<double>(doubles(numbers)), out);
}

}  // namespace metamer::python
