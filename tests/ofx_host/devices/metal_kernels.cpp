// SPDX-License-Identifier: Apache-2.0
#include "metal_kernels.h"

#include <metal_stdlib>

namespace metal_window {
// As the plug-in gives it to the device.
#include "window.metal"
}  // namespace metal_window

void runMetalThread(const std::string& name, const KeptArguments& arguments,
                    const std::vector<unsigned char*>& pointers, unsigned int x, unsigned int y) {
  using namespace metal_window;
  auto* const function = name == "metamerMapWindow"    ? &metamerMapWindow
                         : name == "metamerSkinWindow" ? &metamerSkinWindow
                                                       : &metamerCopyWindow;
  const auto image = [&](std::size_t index) { return arguments.get<MetamerImage>(index); };
  function(pointers[0], image(1), pointers[2], image(3), pointers[4], image(5), arguments.get<MetamerWindow>(6),
           reinterpret_cast<const metal::float4*>(pointers[7]), reinterpret_cast<const metal::uint*>(pointers[8]),
           {x, y});
}
