// SPDX-License-Identifier: Apache-2.0
// A recipe as an OpenColorIO transform with its certificate, in a program of its own; a picture goes through it.
//
//     transform_a_picture OUT.pfm
#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <vector>

#include "metamer/ocio/bake.h"
#include "metamer/sip/recipe.h"
#include "metamer/spectral/data_library.h"

namespace {

namespace OCIO = OCIO_NAMESPACE;

constexpr int kWidth = 96;
constexpr int kHeight = 64;

/// Hues from left to right, six stops from top to bottom; the last column is grey. RGBA, scene-linear.
std::vector<float> testPicture() {
  std::vector<float> rgba;
  for (int y = 0; y < kHeight; ++y) {
    const float light = std::exp2(-6.0F * static_cast<float>(y) / kHeight);
    for (int x = 0; x < kWidth; ++x) {
      const float turn = 6.2831853F * static_cast<float>(x) / kWidth;
      for (int channel = 0; channel < 3; ++channel) {
        const float colour = 0.5F + 0.4F * std::cos(turn - 2.0943951F * static_cast<float>(channel));
        rgba.push_back(light * (x == kWidth - 1 ? 0.5F : colour));
      }
      rgba.push_back(1.0F);
    }
  }
  return rgba;
}

/// Portable float map: three floats a pixel, rows from the bottom up, little-endian.
void writePfm(const char* file, const std::vector<float>& rgba) {
  std::ofstream stream(file, std::ios::binary);
  stream << "PF\n" << kWidth << " " << kHeight << "\n-1.0\n";
  for (int y = kHeight - 1; y >= 0; --y) {
    for (int x = 0; x < kWidth; ++x) {
      stream.write(reinterpret_cast<const char*>(&rgba[static_cast<std::size_t>(4 * (y * kWidth + x))]), 12);
    }
  }
  stream.exceptions(std::ios::failbit | std::ios::badbit);
  stream.flush();
}

bool isNear(float a, float b) {
  return std::abs(a - b) <= 2e-4F * std::abs(b);
}

int transformAPicture(const char* file) {
  const auto library = metamer::spectral::DataLibrary::open(METAMER_DATA_FOLDER);
  const auto recipe = metamer::sip::parseRecipe(
      "metamer: 1\n"
      "name: day_to_sodium\n"
      "space: ACEScg\n"
      "input: {illuminant: D65}\n"
      "output: {illuminant: HP1, adaptation: 1.0}\n",
      "the consumer's recipe");
  metamer::ocio::BakeOptions options;
  options.size = 33;
  const metamer::ocio::Baked baked = metamer::ocio::bake(recipe, library, options);
  std::printf("%s", baked.certificate.json().c_str());

  // From here on it is OpenColorIO's: a processor, a picture.
  const OCIO::ConstGroupTransformRcPtr group = baked.group;
  const auto processor = OCIO::Config::CreateRaw()->getProcessor(group)->getDefaultCPUProcessor();
  const std::vector<float> before = testPicture();
  std::vector<float> after = before;
  OCIO::PackedImageDesc picture(after.data(), kWidth, kHeight, 4);
  processor->apply(picture);
  writePfm(file, after);

  // Greys stay grey, exposure goes through, colours change, alpha does not.
  const auto at = [](const std::vector<float>& pixels, int x, int y, int channel) {
    return pixels[static_cast<std::size_t>(4 * (y * kWidth + x) + channel)];
  };
  bool isRight = true;
  float change = 0.0F;
  for (int y = 0; y < kHeight; ++y) {
    for (int channel = 0; channel < 3; ++channel) {
      isRight = isRight && isNear(at(after, kWidth - 1, y, channel), at(before, kWidth - 1, y, channel));
      for (int x = 0; x + 1 < kWidth; ++x) {
        const float gain = at(before, x, y, 0) / at(before, x, 0, 0);
        isRight = isRight && isNear(at(after, x, y, channel), gain * at(after, x, 0, channel));
        change = std::max(change, std::abs(at(after, x, y, channel) - at(before, x, y, channel)));
      }
    }
    isRight = isRight && at(after, 0, y, 3) == 1.0F;
  }
  if (!isRight || change < 0.1F || baked.certificate.error.mean > 1.0) {
    std::fprintf(stderr, "the picture is not what the recipe says; largest change %g\n", static_cast<double>(change));
    return 1;
  }
  return 0;
}

}  // namespace

int main(int argumentCount, char** arguments) {
  if (argumentCount != 2) {
    std::fputs("usage: transform_a_picture OUT.pfm\n", stderr);
    return 2;
  }
  try {
    return transformAPicture(arguments[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
