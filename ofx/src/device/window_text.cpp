// SPDX-License-Identifier: Apache-2.0
#include "device/window_text.h"

#include "metamer/sip/device_kernels.h"

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

#define METAMER_WINDOW_ENTRY(name, function)                                                                         \
  __kernel void name(__global uchar* source, MetamerImage sourceImage, __global uchar* mask, MetamerImage maskImage, \
                     __global uchar* output, MetamerImage outputImage, MetamerWindow window METAMER_TABLES) {        \
    int column = (int)get_global_id(0);                                                                              \
    int row = (int)get_global_id(1);                                                                                 \
    if (column >= window.width || row >= window.rows) {                                                              \
      return;                                                                                                        \
    }                                                                                                                \
    int x = window.x1 + column;                                                                                      \
    int y = window.y1 + row * window.rowStep;                                                                        \
    if (window.copiesCodes != 0 && metamerHolds(sourceImage, x, y)) {                                                \
      metamerCopyCodes(source + metamerByteOf(sourceImage, x, y), output + metamerByteOf(outputImage, x, y),         \
                       outputImage.channels * outputImage.channelBytes);                                             \
      return;                                                                                                        \
    }                                                                                                                \
    float4 pixel = metamerReadPixel(source, sourceImage, x, y);                                                      \
    float weight = window.mix;                                                                                       \
    if (window.hasMask != 0) {                                                                                       \
      float share = metamerReadPixel(mask, maskImage, x, y).w;                                                       \
      weight = metamerTimes(weight, share > 0.0f ? (share < 1.0f ? share : 1.0f) : 0.0f);                            \
    }                                                                                                                \
    if (weight > 0.0f) {                                                                                             \
      float4 changed = function(pixel METAMER_TABLES_GIVEN);                                                         \
      pixel = METAMER_FLOAT4(metamerBlend(weight, pixel.x, changed.x), metamerBlend(weight, pixel.y, changed.y),     \
                             metamerBlend(weight, pixel.z, changed.z), pixel.w);                                     \
    }                                                                                                                \
    metamerWritePixel(output, outputImage, x, y, pixel);                                                             \
  }

METAMER_WINDOW_ENTRY(metamerCopyWindow, metamerSame)
METAMER_WINDOW_ENTRY(metamerMapWindow, metamerMap)
METAMER_WINDOW_ENTRY(metamerSkinWindow, metamerSkin)
)cl";

}  // namespace

std::string openClWindowText() {
  return "#define METAMER_NO_ENTRY\n" + sip::deviceText(sip::DeviceDialect::OpenCl, sip::DeviceKernel::Map) +
         kSkinText + kWindowText;
}

}  // namespace metamer::ofx
