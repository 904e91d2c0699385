// SPDX-License-Identifier: Apache-2.0
#include "apply/transform.h"

#include <OpenImageIO/parallel.h>

#include <filesystem>
#include <memory>

#include "metamer/ocio/compared_transform.h"
#include "metamer/ocio/pixel_processor.h"
#include "metamer/sip/homogeneous_map.h"
#include "metamer/sip/recipe.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/text.h"
#include "run.h"

namespace metamer::lutgen {
namespace {

bool isRecipe(const std::filesystem::path& file) {
  const std::string extension = spectral::lowerCase(spectral::utf8(file.extension()));
  return extension == ".yaml" || extension == ".yml";
}

AppliedTransform fromRecipe(const TransformRequest& request, const spectral::DataLibrary& library,
                            const ocio::ConfigSource& config) {
  const sip::Recipe recipe = recipeWith(request.transform, request.overrides, library);
  AppliedTransform result;
  result.name = request.transform;
  result.isRecipe = true;
  result.pixels = pictureSpaceNamed(recipe.space, request.transform, library, config);
  result.linearSpace = result.pixels->linear;
  const sip::TransformSpec spec = sip::resolve(recipe, library, result.linearSpace);
  note(sip::notesOf(recipe, spec));
  const auto transform = std::make_shared<const sip::SpectralTransform>(spec);
  result.how = request.engine == "map" ? "map" : "exact engine";
  if (!transform->isIdentity()) {
    result.linear = [transform](std::span<float> rgba) { transform->apply(rgba); };
    if (request.engine == "map") {
      const auto inParallel = [&](int count, const std::function<void(int)>& body) {
        OIIO::parallel_for(
            0, count, [&](std::int64_t k) { body(static_cast<int>(k)); }, OIIO::parallel_options(request.threads));
      };
      const auto map = std::make_shared<const sip::HomogeneousMap>(
          sip::buildHomogeneousMap(*transform, sip::kDefaultMapTolerance, inParallel));
      result.linear = [map](std::span<float> rgba) { map->apply(rgba); };
    }
  }
  result.raw = result.linear ? inTurn({result.pixels->decode, result.linear, result.pixels->encode}) : PixelFunction();
  return result;
}

/// Whether a certificate of metamer's lies beside a LUT file.
bool isCertified(const std::string& file) {
  const std::string certificate = file + ".json";
  std::error_code none;
  return std::filesystem::is_regular_file(spectral::pathOf(certificate), none) &&
         spectral::readTextFile(spectral::pathOf(certificate)).find("\"metamer_certificate\"") != std::string::npos;
}

AppliedTransform fromLut(const TransformRequest& request, const spectral::DataLibrary& library,
                         const ocio::ConfigSource& config) {
  AppliedTransform result;
  result.name = request.transform;
  result.how = "LUT file";
  const ocio::PixelProcessor processor = ocio::PixelProcessor::fromFile(spectral::pathOf(request.transform));
  result.raw = [processor](std::span<float> rgba) { processor.apply(rgba); };
  if (request.overrides.space || isCertified(request.transform)) {
    ocio::LutPixels pixels;
    pixels.space = request.overrides.space.value_or(pixels.space);
    const ocio::ComparedTransform compared =
        ocio::comparedFile(spectral::pathOf(request.transform), pixels, library, config);
    result.linearSpace = compared.space;
    result.linear = compared.apply;
    result.pixels = PictureSpace{"the LUT's own", compared.space, {}, {}};
  }
  return result;
}

}  // namespace

AppliedTransform appliedTransform(const TransformRequest& request, const spectral::DataLibrary& library,
                                  const ocio::ConfigSource& config) {
  if (isRecipe(spectral::pathOf(request.transform))) {
    return fromRecipe(request, library, config);
  }
  if (request.hasRecipeOptions) {
    throw CLI::ValidationError("apply", "a LUT file is applied as it is; options of recipes need a recipe");
  }
  return fromLut(request, library, config);
}

PixelFunction pixelFunction(const AppliedTransform& transform, const std::optional<PictureSpace>& from,
                            const std::optional<PictureSpace>& to) {
  const std::optional<PictureSpace>& out = to ? to : from;
  if (!transform.pixels || (!from && !to)) {
    return transform.raw;
  }
  const PictureSpace& in = from ? *from : *transform.pixels;
  if (!transform.linear && out->name == in.name) {
    return {};
  }
  return inTurn({in.decode, between(in.linear, transform.linearSpace), transform.linear,
                 between(transform.linearSpace, out->linear), out->encode});
}

}  // namespace metamer::lutgen
