// SPDX-License-Identifier: Apache-2.0
// ocio_apply FILE: RGBA floats on stdin through a LUT file to stdout, by the OCIO that this is linked with.
#include <OpenColorIO/OpenColorIO.h>

#include <cstdio>
#include <exception>
#include <vector>

namespace {

namespace OCIO = OCIO_NAMESPACE;

/// With OCIO's exact logarithm, as metamer runs a file.
void runFile(const char* file, std::vector<float>& rgba) {
  auto transform = OCIO::FileTransform::Create();
  transform->setSrc(file);
  transform->setInterpolation(OCIO::INTERP_BEST);
  const auto flags =
      static_cast<OCIO::OptimizationFlags>(OCIO::OPTIMIZATION_DEFAULT & ~OCIO::OPTIMIZATION_FAST_LOG_EXP_POW);
  OCIO::PackedImageDesc pixels(rgba.data(), static_cast<long>(rgba.size() / 4), 1, 4);
  OCIO::Config::CreateRaw()
      ->getProcessor(transform)
      ->getOptimizedCPUProcessor(OCIO::BIT_DEPTH_F32, OCIO::BIT_DEPTH_F32, flags)
      ->apply(pixels);
}

}  // namespace

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
    runFile(arguments[1], pixels);
    return std::fwrite(pixels.data(), sizeof(float), pixels.size(), stdout) == pixels.size() ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "ocio_apply: %s\n", error.what());
    return 1;
  }
}
