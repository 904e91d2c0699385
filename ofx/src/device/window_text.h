// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace metamer::ofx {

/// An image as the kernels are told of it; the text has the same.
struct WindowImage {
  std::int64_t start = 0;     ///< byte of the pixel (0, 0), or where it would be, in its buffer
  std::int64_t rowBytes = 0;  ///< from a row to the one above; may be negative
  std::int32_t x1 = 0;        ///< bounds; empty: there is no image
  std::int32_t y1 = 0;
  std::int32_t x2 = 0;
  std::int32_t y2 = 0;
  std::int32_t channelBytes = 4;  ///< 4: float, 2: half
  std::int32_t channels = 4;      ///< 4: RGBA, 3: RGB, 1: alpha
};

/// What is rendered.
struct Window {
  std::int32_t x1 = 0;
  std::int32_t y1 = 0;
  std::int32_t width = 0;
  std::int32_t rows = 0;
  std::int32_t rowStep = 1;  ///< 2: every other row, those of a field
  std::int32_t hasMask = 0;
  float mix = 1.0F;
  std::int32_t copiesCodes = 0;  ///< nothing is done to a pixel, nor to its format
  std::int32_t divides = 0;      ///< alpha is divided out before and multiplied back after
};

/// The arguments of each kernel, in order.
enum class WindowArgument : std::uint32_t {
  Source,
  SourceImage,
  Mask,
  MaskImage,
  Output,
  OutputImage,
  Window,
  Nodes,
  Cells,
  Curve  ///< of the kernels between curves alone
};

/// Kernels over a window, one work item a pixel and row: pixels in the host's memory as render() takes them, to its
/// bits.
inline constexpr const char* kCopyWindow = "metamerCopyWindow";  ///< reads no tables
inline constexpr const char* kMapWindow = "metamerMapWindow";    ///< tables of sip::DeviceKernel::Map
inline constexpr const char* kSkinWindow = "metamerSkinWindow";  ///< tables of SkinPixels
/// Where the device has doubles, these as well: tables of AffinePixels; the two above between the curves of a
/// SignalTable.
inline constexpr const char* kAffineWindow = "metamerAffineWindow";
inline constexpr const char* kMapCurveWindow = "metamerMapCurveWindow";
inline constexpr const char* kSkinCurveWindow = "metamerSkinCurveWindow";

/// All of them in a language, by the name of its file: "window.cl", "window.ptx", "window.metal". Empty where the build
/// had no compiler for it. The text is kept and ends with a zero.
std::string_view windowText(std::string_view name);

}  // namespace metamer::ofx
