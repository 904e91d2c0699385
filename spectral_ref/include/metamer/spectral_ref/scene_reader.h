// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "metamer/spectral/data_library.h"
#include "metamer/spectral_ref/scene.h"

namespace metamer::spectral_ref {

/// Largest scene file, bytes; meshes, pictures and spectra are files of their own.
inline constexpr std::uintmax_t kLargestSceneBytes = 64u << 20;

/// Reads a scene file (docs/spectral_ref.md) and everything it names.
/// @throws spectral::InputError naming the file, line and column, the field, the value and the remedy
Scene readScene(const std::filesystem::path& file, const spectral::DataLibrary& library);

/// The same from text. @param where what messages call it @param folder that relative files are looked for in
Scene parseScene(const std::string& text, const std::string& where, const std::filesystem::path& folder,
                 const spectral::DataLibrary& library);

}  // namespace metamer::spectral_ref
