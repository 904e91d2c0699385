// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "apply/picture_space.h"
#include "overrides.h"

namespace metamer::lutgen {

/// What is applied: a recipe, by the engine or its map, or a LUT file.
struct AppliedTransform {
  std::string name;  ///< as the user gave it
  std::string how;   ///< for the summary: "exact engine", "map", "LUT file"
  bool isRecipe = false;
  std::optional<PictureSpace> pixels;  ///< what it is made for; empty: a LUT that does not say
  spectral::RgbSpace linearSpace;      ///< of `linear`
  PixelFunction linear;                ///< on linear pixels; empty: changes nothing. Only where `pixels` is known
  PixelFunction raw;                   ///< on pixels as they are: of a picture that does not say what it holds
};

struct TransformRequest {
  std::string transform;  ///< recipe or LUT file
  std::string engine = "exact";
  Overrides overrides;
  bool hasRecipeOptions = false;  ///< others than --space
  int threads = 0;
};

/// Built once, applied to any picture on any thread.
/// @throws spectral::InputError; CLI::ValidationError for options of recipes with a LUT file
AppliedTransform appliedTransform(const TransformRequest& request, const spectral::DataLibrary& library,
                                  const ocio::ConfigSource& config);

/// The function for pictures of `from`, written in `to`. @param from  empty: not known, taken as the transform's own
PixelFunction pixelFunction(const AppliedTransform& transform, const std::optional<PictureSpace>& from,
                            const std::optional<PictureSpace>& to);

}  // namespace metamer::lutgen
