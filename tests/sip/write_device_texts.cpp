// SPDX-License-Identifier: Apache-2.0
// write_device_texts FOLDER: the kernels in every language, as files for other compilers: map.metal, affine.glsl, ...
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <utility>

#include "metamer/sip/device_kernels.h"

int main(int argc, char** argv) {
  using namespace metamer::sip;
  if (argc != 2) {
    return EXIT_FAILURE;
  }
  const std::filesystem::path folder = argv[1];
  constexpr std::array kExtensions = {std::pair{DeviceDialect::OpenCl, ".cl"}, std::pair{DeviceDialect::Cuda, ".cu"},
                                      std::pair{DeviceDialect::Metal, ".metal"},
                                      std::pair{DeviceDialect::Glsl, ".comp"}, std::pair{DeviceDialect::Hlsl, ".hlsl"}};
  static_assert(kExtensions.size() == kDeviceDialects.size());
  for (const auto& [dialect, extension] : kExtensions) {
    std::ofstream(folder / (std::string("map") + extension)) << deviceText(dialect, DeviceKernel::Map);
    std::ofstream(folder / (std::string("affine") + extension)) << deviceText(dialect, DeviceKernel::Affine);
  }
  return EXIT_SUCCESS;
}
