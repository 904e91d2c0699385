// SPDX-License-Identifier: Apache-2.0
#include "spectral_ref/picture_fixture.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include "spectral/temporary_folder.h"

namespace metamer::spectral_ref {

namespace {

std::filesystem::path written(const std::string& file, const OIIO::ImageSpec& spec, const void* values) {
  std::filesystem::path path = scratchFile(file);
  const auto output = OIIO::ImageOutput::create(path.string());
  const bool isWritten =
      output && output->open(path.string(), spec) && output->write_image(spec.format, values) && output->close();
  EXPECT_TRUE(isWritten) << path << ": " << OIIO::geterror();
  return path;
}

}  // namespace

std::filesystem::path exrFile(const std::string& name, int width, int height, int channels,
                              const std::vector<float>& values, const std::vector<std::string>& names) {
  OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::FLOAT);
  if (!names.empty()) {
    spec.channelnames = names;
  }
  return written(name + ".exr", spec, values.data());
}

std::filesystem::path pngFile(const std::string& name, int width, int height, int channels,
                              const std::vector<std::uint8_t>& values) {
  return written(name + ".png", {width, height, channels, OIIO::TypeDesc::UINT8}, values.data());
}

}  // namespace metamer::spectral_ref
