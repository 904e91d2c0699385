// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "metamer/ocio/bake.h"
#include "metamer/sip/device_kernels.h"

namespace metamer::ocio {

/// A language that a transform is written in for GPUs and viewers.
struct ShaderFormat {
  std::string name;                                ///< "opencl", ...
  std::string extension;                           ///< with its dot
  std::string use;                                 ///< one line for a list
  std::optional<sip::DeviceDialect> dialect = {};  ///< of the exact map; none: DCTL, which holds a grid of it
};

/// All that there are.
const std::vector<ShaderFormat>& shaderFormats();

/// The format of a file, by `formatName` (a name, or an extension without its dot) or else by its extension; null where
/// that is none of a shader's.
/// @throws spectral::InputError: a name whose extension is not the file's
const ShaderFormat* findShaderFormat(const std::filesystem::path& file, const std::string& formatName);

/// The transform's map (sip/homogeneous_map.h) as text that compiles in the language, for linear pixels of the recipe's
/// space: what it does and how to use it in comments, the kernel, and its tables in a comment at the end, in base64, as
/// compilers take megabytes of numbers slowly and devices hold few constants. The error is measured through the
/// kernel's text, compiled for the processor, with the tables read from the written text.
/// DCTL holds the map as a grid (sip/chromaticity_grid.h), in the cube that its language has.
/// @param options  without size, shaper, shaper size, stops or nodes that are sampled: a map has none
/// @throws spectral::InputError: an option that a map has no use for, a space that is not linear or is a config's, a
///         tolerance that the map does not hold; as bake()
BakedText bakeShaderText(const sip::Recipe& recipe, const spectral::DataLibrary& library, const ShaderFormat& format,
                         const BakeOptions& options = {});

/// The same as a file and its certificate beside it, as bakeFile() writes them.
Certificate bakeShaderFile(const sip::Recipe& recipe, const spectral::DataLibrary& library,
                           const std::filesystem::path& file, const ShaderFormat& format,
                           const BakeOptions& options = {});

/// The tables of a shader file. @throws spectral::InputError where the text holds none, or not all of them
sip::DeviceTables shaderTables(const std::string& text);

}  // namespace metamer::ocio
