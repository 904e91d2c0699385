// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/shader_bake.h"

#include <algorithm>

#include "bake/certified_file.h"
#include "bake/judged_recipe.h"
#include "files/shader_text.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/spectral/text.h"
#include "operators/parallel.h"

namespace metamer::ocio {
namespace {

using spectral::InputError;

constexpr double kBuiltShare = 0.4;

void requireMapOptions(const BakeOptions& options, const ShaderFormat& format) {
  const auto refuse = [&](const std::string& field, const std::string& value, const std::string& why) {
    throw InputError("", field, value, "is nothing for " + format.extension + ": " + why + "; leave it out");
  };
  if (options.size != 0) {
    refuse("size", std::to_string(options.size), "its table finds its own size, by its error");
  }
  if (options.shaper) {
    refuse("shaper", nameOf(*options.shaper), "it takes linear pixels of any exposure");
  }
  if (options.shaperSize != 0) {
    refuse("shaper size", std::to_string(options.shaperSize), "it has no curve");
  }
  if (!options.fitted) {
    refuse("sampled", "yes", "its table is neither fitted nor sampled but checked, patch by patch");
  }
  if (options.representation) {
    refuse("representation", nameOf(*options.representation), "it holds the homogeneous map");
  }
}

sip::ErrorProtocol::Options probesOf(const WorkingSpace& space, const BakeOptions& options) {
  if (space.toEngine || !space.isLinear) {
    throw InputError("", "space", space.name,
                     "is not a linear space of metamer's own, which a shader's pixels are; name one (lutgen list "
                     "spaces), and convert before and after");
  }
  return probesWanted({}, options);
}

}  // namespace

const std::vector<ShaderFormat>& shaderFormats() {
  using sip::DeviceDialect;
  static const std::vector<ShaderFormat> formats = {
      {"opencl", ".cl", "OpenCL C 1.2; the exact map, linear pixels of any exposure", DeviceDialect::OpenCl},
      {"cuda", ".cu", "CUDA C++; the exact map, linear pixels of any exposure", DeviceDialect::Cuda},
      {"metal", ".metal", "Metal; the exact map, linear pixels of any exposure", DeviceDialect::Metal},
      {"glsl", ".glsl", "GLSL 4.30; the exact map, linear pixels of any exposure", DeviceDialect::Glsl},
      {"hlsl", ".hlsl", "HLSL, shader model 5; the exact map, linear pixels of any exposure", DeviceDialect::Hlsl},
      {"dctl", ".dctl", "DCTL of DaVinci Resolve; a fine grid of the map, linear pixels of any exposure"},
  };
  return formats;
}

const ShaderFormat* findShaderFormat(const std::filesystem::path& file, const std::string& formatName) {
  const std::string extension = spectral::lowerCase(spectral::utf8(file.extension()));
  const std::string wanted = spectral::lowerCase(formatName);
  const auto& formats = shaderFormats();
  const auto found = std::find_if(formats.begin(), formats.end(), [&](const ShaderFormat& format) {
    return formatName.empty() ? format.extension == extension
                              : format.name == wanted || format.extension == "." + wanted;
  });
  if (found == formats.end()) {
    return nullptr;
  }
  if (!file.empty() && found->extension != extension && !spectral::isStream(file)) {
    throw InputError(spectral::utf8(file), "extension", extension,
                     "is not that of " + found->name + "; name the file *" + found->extension);
  }
  return &*found;
}

BakedText bakeShaderText(const sip::Recipe& recipe, const spectral::DataLibrary& library, const ShaderFormat& format,
                         const BakeOptions& options) {
  requireMapOptions(options, format);
  JudgedRecipe judged(recipe, library, options, [&](const WorkingSpace& space) { return probesOf(space, options); });
  Certificate& certificate = judged.certificate();
  const sip::HomogeneousMap map =
      sip::buildHomogeneousMap(judged.prepared().transform, sip::kDefaultMapTolerance, parallelFor);
  certificate.representation = map.identity ? Representation::Identity : Representation::HomogeneousMap;
  certificate.format = format.name;
  judged.tell(kBuiltShare);
  std::string text;
  if (format.dialect) {
    // Twice: what the file says of itself is known before it is written, what the certificate says after.
    judged.certify([&](std::span<float> rgba) { map.apply(rgba); });
    text = shaderText(*format.dialect, sip::deviceTables(map), descriptionOf(certificate));
    const sip::DeviceTables tables = shaderTables(text);
    judged.certify([&](std::span<float> rgba) { sip::applyDeviceKernel(sip::DeviceKernel::Map, tables, rgba); });
  } else {
    const sip::ChromaticityGrid grid = sip::chromaticityGrid(map);
    certificate.size = map.identity ? 0 : sip::ChromaticityGrid::kSide;
    judged.certify([&](std::span<float> rgba) { sip::applyChromaticityGrid(grid, rgba); });
    text = shaderText(grid, descriptionOf(certificate));
  }
  if (options.tolerance && certificate.error.p99 > *options.tolerance) {
    throw InputError("", "tolerance", spectral::threeDigits(*options.tolerance),
                     "is less than the map has: its 99th percentile is " +
                         spectral::threeDigits(certificate.error.p99) +
                         ", most of it the engine's number of bands; allow more");
  }
  certificate.sha256 = sha256(text);
  return {std::move(text), std::move(certificate)};
}

Certificate bakeShaderFile(const sip::Recipe& recipe, const spectral::DataLibrary& library,
                           const std::filesystem::path& file, const ShaderFormat& format, const BakeOptions& options) {
  CertifiedFile shader(file);
  BakedText baked = bakeShaderText(recipe, library, format, options);
  shader.file().write(baked.text);
  shader.commit(baked.certificate);
  return std::move(baked.certificate);
}

}  // namespace metamer::ocio
