// SPDX-License-Identifier: Apache-2.0
#include "device/window_text.h"

#include "metamer/sip/device_kernels.h"
#include "metamer/spectral/text.h"
#include "pixels/signal_table.h"

namespace metamer::ofx {
namespace {

/// SkinPixels::applyMap in its operations and order.
constexpr const char* kSkinText = R"cl(
// Nodes: low and scale of the two chromaticities; then the changes, row by row. Cells: those along each chromaticity.
METAMER_FUNCTION float metamerSkinAlong(float at, float most) {
  float least = at > 0.0f ? at : 0.0f;
  return least < most ? least : most;
}

METAMER_FUNCTION float metamerSkinBetween(float weight, float from, float to) {
  return metamerPlus(from, metamerTimes(weight, metamerMinus(to, from)));
}

METAMER_FUNCTION float4 metamerSkin(float4 pixel METAMER_TABLES) {
  float4 form = METAMER_NODE(0u);
  uint cells = METAMER_CELL(0u);
  float most = METAMER_FLOAT(cells);
  float last = metamerMinus(most, 1.0f);
  float mean = metamerTimes(metamerPlus(metamerPlus(pixel.x, pixel.y), pixel.z), 1.0f / 3.0f);
  // Written so that what is no number, and what may become none, stays.
  if (!(mean > 0.0f && mean <= 1e30f)) {
    return pixel;
  }
  float inverse = metamerQuotient(1.0f, mean);
  float x = metamerSkinAlong(
      metamerTimes(metamerMinus(metamerTimes(metamerMinus(pixel.x, pixel.y), inverse), form.x), form.z), most);
  float y = metamerSkinAlong(
      metamerTimes(metamerMinus(metamerTimes(metamerMinus(pixel.z, pixel.y), inverse), form.y), form.w), most);
  uint i = METAMER_UINT(x < last ? x : last);
  uint j = METAMER_UINT(y < last ? y : last);
  float u = metamerMinus(x, METAMER_FLOAT(i));
  float v = metamerMinus(y, METAMER_FLOAT(j));
  uint node = 1u + i * (cells + 1u) + j;
  float4 a = METAMER_NODE(node);
  float4 b = METAMER_NODE(node + 1u);
  float4 c = METAMER_NODE(node + cells + 1u);
  float4 d = METAMER_NODE(node + cells + 2u);
  float red = metamerSkinBetween(u, metamerSkinBetween(v, a.x, b.x), metamerSkinBetween(v, c.x, d.x));
  float green = metamerSkinBetween(u, metamerSkinBetween(v, a.y, b.y), metamerSkinBetween(v, c.y, d.y));
  float blue = metamerSkinBetween(u, metamerSkinBetween(v, a.z, b.z), metamerSkinBetween(v, c.z, d.z));
  return METAMER_FLOAT4(metamerPlus(pixel.x, metamerTimes(mean, red)), metamerPlus(pixel.y, metamerTimes(mean, green)),
                        metamerPlus(pixel.z, metamerTimes(mean, blue)), pixel.w);
}
)cl";

/// A window of the host's images: what render() does around a transform, with its bits.
constexpr const char* kWindowText = R"cl(
typedef struct {
  long start;
  long rowBytes;
  int x1;
  int y1;
  int x2;
  int y2;
  int channelBytes;
  int channels;
} MetamerImage;

typedef struct {
  int x1;
  int y1;
  int width;
  int rows;
  int rowStep;
  int hasMask;
  float mix;
  int copiesCodes;
  int divides;
} MetamerWindow;

typedef __global uchar* MetamerBytes;

// Halves by their bits: no device needs to know them, and all round alike.
METAMER_FUNCTION float metamerFromHalf(uint code) {
  uint bits = (code & 0x7fffu) << 13;
  uint exponent = bits & 0x0f800000u;
  bits += 112u << 23;
  if (exponent == 0x0f800000u) {
    bits += 112u << 23;
  } else if (exponent == 0u) {
    bits = metamerBits(metamerMinus(metamerFloat(bits + (1u << 23)), metamerFloat(113u << 23)));
  }
  return metamerFloat(bits | ((code & 0x8000u) << 16));
}

// To the nearest, ties to even; finite numbers stay so.
METAMER_FUNCTION uint metamerToHalf(float value) {
  uint bits = metamerBits(value) & 0x7fffffffu;
  uint sign = (metamerBits(value) >> 16) & 0x8000u;
  if (bits >= 0x7f800000u) {
    return sign | (bits > 0x7f800000u ? 0x7e00u : 0x7c00u);
  }
  bits = bits < 0x477fe000u ? bits : 0x477fe000u;
  if (bits < (113u << 23)) {
    return sign | (metamerBits(metamerPlus(metamerFloat(bits), 0.5f)) - 0x3f000000u);
  }
  return sign | ((bits - (112u << 23) + 0xfffu + ((bits >> 13) & 1u)) >> 13);
}

METAMER_FUNCTION bool metamerHolds(MetamerImage image, int x, int y) {
  return x >= image.x1 && x < image.x2 && y >= image.y1 && y < image.y2;
}

METAMER_FUNCTION long metamerByteOf(MetamerImage image, int x, int y) {
  return image.start + y * image.rowBytes + (long)x * (image.channels * image.channelBytes);
}

METAMER_FUNCTION float metamerChannel(MetamerBytes pixel, MetamerImage image, int k) {
  return image.channelBytes == 2 ? metamerFromHalf(((__global const ushort*)pixel)[k])
                                 : ((__global const float*)pixel)[k];
}

METAMER_FUNCTION float4 metamerReadPixel(MetamerBytes bytes, MetamerImage image, int x, int y) {
  float4 pixel = METAMER_FLOAT4(0.0f, 0.0f, 0.0f, 0.0f);
  if (metamerHolds(image, x, y)) {
    MetamerBytes at = bytes + metamerByteOf(image, x, y);
    if (image.channels != 1) {
      pixel.x = metamerChannel(at, image, 0);
      pixel.y = metamerChannel(at, image, 1);
      pixel.z = metamerChannel(at, image, 2);
    }
    pixel.w = image.channels == 3 ? 1.0f : metamerChannel(at, image, image.channels - 1);
  }
  return pixel;
}

METAMER_FUNCTION void metamerPutChannel(MetamerBytes pixel, MetamerImage image, int k, float value) {
  if (image.channelBytes == 2) {
    ((__global ushort*)pixel)[k] = (ushort)metamerToHalf(value);
  } else {
    ((__global float*)pixel)[k] = value;
  }
}

METAMER_FUNCTION void metamerWritePixel(MetamerBytes bytes, MetamerImage image, int x, int y, float4 pixel) {
  MetamerBytes at = bytes + metamerByteOf(image, x, y);
  if (image.channels != 1) {
    metamerPutChannel(at, image, 0, pixel.x);
    metamerPutChannel(at, image, 1, pixel.y);
    metamerPutChannel(at, image, 2, pixel.z);
  }
  if (image.channels != 3) {
    metamerPutChannel(at, image, image.channels - 1, pixel.w);
  }
}

METAMER_FUNCTION void metamerCopyCodes(MetamerBytes source, MetamerBytes output, int bytes) {
  for (int k = 0; k < bytes / 2; ++k) {
    ((__global ushort*)output)[k] = ((__global const ushort*)source)[k];
  }
}

METAMER_FUNCTION float metamerBlend(float weight, float pixel, float changed) {
  return weight >= 1.0f ? changed
                        : metamerPlus(metamerTimes(metamerMinus(1.0f, weight), pixel), metamerTimes(weight, changed));
}

METAMER_FUNCTION float4 metamerSame(float4 pixel METAMER_TABLES) {
  return pixel;
}

METAMER_FUNCTION bool metamerHasColour(float4 pixel) {
  return metamerIsFinite(pixel.x) && metamerIsFinite(pixel.y) && metamerIsFinite(pixel.z);
}

METAMER_FUNCTION float metamerWeight(MetamerWindow window, MetamerBytes mask, MetamerImage maskImage, int x, int y) {
  float share = window.hasMask != 0 ? metamerReadPixel(mask, maskImage, x, y).w : 1.0f;
  return metamerTimes(window.mix, share > 0.0f ? (share < 1.0f ? share : 1.0f) : 0.0f);
}

// The colour that a transform is given: without its alpha where that is divided out.
METAMER_FUNCTION float4 metamerGiven(MetamerWindow window, float4 pixel) {
  return window.divides == 0 || !(pixel.w > 0.0f)
             ? pixel
             : METAMER_FLOAT4(metamerQuotient(pixel.x, pixel.w), metamerQuotient(pixel.y, pixel.w),
                              metamerQuotient(pixel.z, pixel.w), pixel.w);
}

// What becomes of the result. Pixels of alpha 0 carry no colour of their own and stay, and so does what division takes
// beyond the range of float.
METAMER_FUNCTION float4 metamerTaken(MetamerWindow window, float4 pixel, float4 changed) {
  if (window.divides == 0) {
    return changed;
  }
  float4 result = METAMER_FLOAT4(metamerTimes(changed.x, pixel.w), metamerTimes(changed.y, pixel.w),
                                 metamerTimes(changed.z, pixel.w), pixel.w);
  return pixel.w > 0.0f && metamerHasColour(pixel) && metamerHasColour(result) ? result : pixel;
}

METAMER_FUNCTION float4 metamerBlended(float weight, float4 pixel, float4 changed) {
  return METAMER_FLOAT4(metamerBlend(weight, pixel.x, changed.x), metamerBlend(weight, pixel.y, changed.y),
                        metamerBlend(weight, pixel.z, changed.z), pixel.w);
}

#define METAMER_CURVE
#define METAMER_CURVE_GIVEN
#define METAMER_WINDOW_ENTRY(name, function)                                                                         \
  __kernel void name(__global uchar* source, MetamerImage sourceImage, __global uchar* mask, MetamerImage maskImage, \
                     __global uchar* output, MetamerImage outputImage,                                               \
                     MetamerWindow window METAMER_TABLES METAMER_CURVE) {                                            \
    int x = window.x1 + (int)get_global_id(0);                                                                       \
    int y = window.y1 + (int)get_global_id(1) * window.rowStep;                                                      \
    if ((int)get_global_id(0) >= window.width || (int)get_global_id(1) >= window.rows) {                             \
      return;                                                                                                        \
    }                                                                                                                \
    if (window.copiesCodes != 0 && metamerHolds(sourceImage, x, y)) {                                                \
      metamerCopyCodes(source + metamerByteOf(sourceImage, x, y), output + metamerByteOf(outputImage, x, y),         \
                       outputImage.channels * outputImage.channelBytes);                                             \
      return;                                                                                                        \
    }                                                                                                                \
    float4 pixel = metamerReadPixel(source, sourceImage, x, y);                                                      \
    float weight = metamerWeight(window, mask, maskImage, x, y);                                                     \
    if (weight > 0.0f) {                                                                                             \
      float4 changed = function(metamerGiven(window, pixel) METAMER_TABLES_GIVEN METAMER_CURVE_GIVEN);               \
      pixel = metamerBlended(weight, pixel, metamerTaken(window, pixel, changed));                                   \
    }                                                                                                                \
    metamerWritePixel(output, outputImage, x, y, pixel);                                                             \
  }

METAMER_WINDOW_ENTRY(metamerCopyWindow, metamerSame)
METAMER_WINDOW_ENTRY(metamerMapWindow, metamerMap)
METAMER_WINDOW_ENTRY(metamerSkinWindow, metamerSkin)
)cl";

/// AffinePixels and SignalTable, which reckon in doubles, in their operations and order.
constexpr const char* kDoublesText = R"cl(
#ifdef cl_khr_fp64
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
typedef __global const double* MetamerDoubles;

// A log curve: gain, shift, scale and offset of the logarithm above and of that below; light and signal where the one
// begins and where the other ends; slope of the line between.
METAMER_FUNCTION double metamerLogarithm(MetamerDoubles piece, double light) {
  return piece[2] * log10(piece[0] * light + piece[1]) + piece[3];
}

METAMER_FUNCTION double metamerExponential(MetamerDoubles piece, double signal) {
  return (pow(10.0, (signal - piece[3]) / piece[2]) - piece[1]) / piece[0];
}

METAMER_FUNCTION double metamerEncode(MetamerDoubles curve, double light) {
  if (light >= curve[8]) {
    return metamerLogarithm(curve, light);
  }
  return light < curve[10] ? metamerLogarithm(curve + 4, light) : curve[9] + curve[12] * (light - curve[8]);
}

METAMER_FUNCTION double metamerDecode(MetamerDoubles curve, double signal) {
  if (signal >= curve[9]) {
    return metamerExponential(curve, signal);
  }
  return signal < curve[11] ? metamerExponential(curve + 4, signal) : curve[8] + (signal - curve[9]) / curve[12];
}

#define METAMER_PIECES 13

// A parabola a cell; what is no number is asked of the curve.
METAMER_FUNCTION double metamerOnCell(MetamerDoubles cell, double rest) {
  return cell[0] + rest * (cell[1] + rest * cell[2]);
}

METAMER_FUNCTION float metamerDecodeByTable(MetamerDoubles curve, float signal) {
  double position = ((double)signal - METAMER_LEAST_SIGNAL) * METAMER_CELLS_PER_SIGNAL;
  if (position >= 0.0 && position < METAMER_SIGNAL_CELLS) {
    int index = (int)position;
    double light = metamerOnCell(curve + METAMER_PIECES + 3 * index, position - (double)index);
    if (light == light) {
      return (float)light;
    }
  }
  return (float)metamerDecode(curve, (double)signal);
}

METAMER_FUNCTION float metamerEncodeByTable(MetamerDoubles curve, float light) {
  uint magnitude = metamerBits(light) & 0x7fffffffu;
  uint index = (magnitude >> METAMER_REST_BITS) - METAMER_FIRST_CELL;
  if (index < METAMER_CELLS_A_SIGN) {
    index += (metamerBits(light) >> 31) != 0u ? METAMER_CELLS_A_SIGN : 0u;
    double rest = (double)(magnitude & ((1u << METAMER_REST_BITS) - 1u)) * (1.0 / (1u << METAMER_REST_BITS));
    double signal = metamerOnCell(curve + METAMER_PIECES + 3 * (METAMER_SIGNAL_CELLS + index), rest);
    if (signal == signal) {
      return (float)signal;
    }
  }
  return (float)metamerEncode(curve, (double)light);
}

METAMER_FUNCTION float4 metamerDecoded(float4 pixel, MetamerDoubles curve) {
  return METAMER_FLOAT4(metamerDecodeByTable(curve, pixel.x), metamerDecodeByTable(curve, pixel.y),
                        metamerDecodeByTable(curve, pixel.z), pixel.w);
}

METAMER_FUNCTION float4 metamerEncoded(float4 pixel, float4 light, MetamerDoubles curve) {
  return metamerHasColour(pixel) ? METAMER_FLOAT4(metamerEncodeByTable(curve, light.x),
                                                  metamerEncodeByTable(curve, light.y),
                                                  metamerEncodeByTable(curve, light.z), pixel.w)
                                 : pixel;
}

METAMER_FUNCTION bool metamerIsFiniteDouble(double x) {
  return (as_ulong(x) & 0x7ff0000000000000ul) != 0x7ff0000000000000ul;
}

METAMER_FUNCTION double metamerClamped(MetamerDoubles form, double value) {
  return form[12] != 0.0 && value < 0.0 ? 0.0 : value;
}

// Cells, as doubles: the matrix's rows, the offset, 1 where nothing lies below 0, 1 where there is a curve, its pieces.
METAMER_FUNCTION float4 metamerAffineDouble(float4 pixel METAMER_TABLES) {
  MetamerDoubles form = (MetamerDoubles)metamerCells;
  bool isEncoded = form[13] != 0.0;
  double r = isEncoded ? metamerDecode(form + 14, (double)pixel.x) : (double)pixel.x;
  double g = isEncoded ? metamerDecode(form + 14, (double)pixel.y) : (double)pixel.y;
  double b = isEncoded ? metamerDecode(form + 14, (double)pixel.z) : (double)pixel.z;
  // In the order in which Eigen sums: the first two rows at once, the third by halves.
  double red = metamerClamped(form, ((form[0] * r + form[1] * g) + form[2] * b) + form[9]);
  double green = metamerClamped(form, ((form[3] * r + form[4] * g) + form[5] * b) + form[10]);
  double blue = metamerClamped(form, (form[6] * r + (form[7] * g + form[8] * b)) + form[11]);
  if (isEncoded) {
    red = metamerEncode(form + 14, red);
    green = metamerEncode(form + 14, green);
    blue = metamerEncode(form + 14, blue);
  }
  bool isFinite = metamerHasColour(pixel) && metamerIsFiniteDouble(red) && metamerIsFiniteDouble(green) &&
                  metamerIsFiniteDouble(blue);
  return isFinite ? METAMER_FLOAT4((float)red, (float)green, (float)blue, pixel.w) : pixel;
}

METAMER_WINDOW_ENTRY(metamerAffineWindow, metamerAffineDouble)

#undef METAMER_CURVE
#undef METAMER_CURVE_GIVEN
#define METAMER_CURVE , __global const double* metamerCurve
#define METAMER_CURVE_GIVEN , metamerCurve
METAMER_FUNCTION float4 metamerMapBetweenCurves(float4 pixel METAMER_TABLES METAMER_CURVE) {
  float4 light = metamerDecoded(pixel, metamerCurve);
  return metamerEncoded(pixel, metamerMap(light METAMER_TABLES_GIVEN), metamerCurve);
}

METAMER_FUNCTION float4 metamerSkinBetweenCurves(float4 pixel METAMER_TABLES METAMER_CURVE) {
  float4 light = metamerDecoded(pixel, metamerCurve);
  return metamerEncoded(pixel, metamerSkin(light METAMER_TABLES_GIVEN), metamerCurve);
}

METAMER_WINDOW_ENTRY(metamerMapCurveWindow, metamerMapBetweenCurves)
METAMER_WINDOW_ENTRY(metamerSkinCurveWindow, metamerSkinBetweenCurves)
#endif
)cl";

/// The form of a SignalTable.
std::string tableForm() {
  const auto define = [](const char* name, const std::string& value) {
    return std::string("#define METAMER_") + name + " " + value + "\n";
  };
  return define("LEAST_SIGNAL", "(" + spectral::shortestNumber(SignalTable::kLeastSignal) + ")") +
         define("CELLS_PER_SIGNAL", spectral::shortestNumber(SignalTable::kCellsPerSignal)) +
         define("SIGNAL_CELLS", std::to_string(SignalTable::kSignalCells)) +
         define("REST_BITS", std::to_string(SignalTable::kRestBits)) +
         define("FIRST_CELL", std::to_string(SignalTable::kFirstCell) + "u") +
         define("CELLS_A_SIGN", std::to_string(SignalTable::kCellsASign) + "u");
}

}  // namespace

std::string openClWindowText() {
  return "#define METAMER_NO_ENTRY\n" + sip::deviceText(sip::DeviceDialect::OpenCl, sip::DeviceKernel::Map) +
         kSkinText + kWindowText + tableForm() + kDoublesText;
}

}  // namespace metamer::ofx
