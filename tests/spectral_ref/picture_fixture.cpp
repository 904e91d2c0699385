// SPDX-License-Identifier: Apache-2.0
#include "spectral_ref/picture_fixture.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include "spectral/temporary_folder.h"

namespace metamer::spectral_ref {

std::filesystem::path exrFile(const std::string& name, int width, int height, int channels,
                              const std::vector<float>& values) {
  std::filesystem::path path = scratchFile(name + ".exr");
  const auto output = OIIO::ImageOutput::create(path.string());
  const OIIO::ImageSpec spec(width, height, channels, OIIO::TypeDesc::FLOAT);
  const bool isWritten = output && output->open(path.string(), spec) &&
                         output->write_image(OIIO::TypeDesc::FLOAT, values.data()) && output->close();
  EXPECT_TRUE(isWritten) << path << ": " << OIIO::geterror();
  return path;
}

}  // namespace metamer::spectral_ref
