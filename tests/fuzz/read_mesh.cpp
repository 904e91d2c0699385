// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "refusal.h"
#include "scene_file/scene_mesh.h"
#include "temporary_input.h"

/// Whatever the bytes of an .obj (first byte even) or .ply file are, the renderer's own reader gives triangles of
/// vertices that are there and finite, or one short line of error.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace metamer;
  if (size == 0) {
    return 0;
  }
  const TemporaryInput input(data[0] % 2 == 0 ? ".obj" : ".ply", data + 1, size - 1);
  try {
    const auto mesh = spectral_ref::readMesh(spectral_ref::YamlValue::ofText(input.path().filename().string(), "mesh"),
                                             input.path().parent_path());
    require(!mesh.triangles.empty());
    for (const auto& triangle : mesh.triangles) {
      for (const std::uint32_t corner : triangle) {
        require(corner < mesh.vertices.size());
      }
    }
    for (const auto& vertex : mesh.vertices) {
      require(std::isfinite(vertex[0]) && std::isfinite(vertex[1]) && std::isfinite(vertex[2]));
    }
  } catch (const spectral::InputError& error) {
    checkRefusal(error);
  }
  return 0;
}
