// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "metamer/spectral_ref/scene.h"
#include "scene_file/scene_value.h"

namespace metamer::spectral_ref {

/// Triangles of an OBJ or PLY file, all its parts as one. Triangles without area or with a coordinate that is no finite
/// number are left out and counted. @throws spectral::InputError: unreadable, no triangle left
Mesh readMesh(const YamlValue& file, const std::filesystem::path& folder);

}  // namespace metamer::spectral_ref
