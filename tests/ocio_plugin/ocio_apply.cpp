// SPDX-License-Identifier: Apache-2.0
// ocio_apply FILE: RGBA floats on stdin through a LUT file to stdout.
#include <cstdio>
#include <exception>
#include <vector>

#include "metamer/ocio/pixel_processor.h"

int main(int argumentCount, char** arguments) {
  if (argumentCount != 2) {
    std::fputs("usage: ocio_apply FILE < floats > floats\n", stderr);
    return 2;
  }
  try {
    std::vector<float> pixels;
    std::vector<float> block(4096);
    for (std::size_t got = 1; got > 0;) {
      got = std::fread(block.data(), sizeof(float), block.size(), stdin);
      pixels.insert(pixels.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(got));
    }
    metamer::ocio::PixelProcessor::fromFile(arguments[1]).apply(pixels);
    return std::fwrite(pixels.data(), sizeof(float), pixels.size(), stdout) == pixels.size() ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "ocio_apply: %s\n", error.what());
    return 1;
  }
}
