// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "metamer/ocio/config_source.h"
#include "metamer/sip/comparison.h"
#include "metamer/sip/error_protocol.h"
#include "metamer/sip/recipe.h"
#include "metamer/spectral/data_library.h"

namespace metamer::ocio {

namespace OCIO = OCIO_NAMESPACE;

/// A transform as a function of linear pixels, wherever it comes from.
struct ComparedTransform {
  std::string kind;  ///< "recipe", "LUT file", "look"
  std::string name;  ///< as the user gave it
  spectral::RgbSpace space;
  std::function<void(std::span<float> rgba)> apply;  ///< RGBA pixels, linear in `space`, in place
  sip::ErrorProtocol::Options probes;                ///< the range it is made for
  std::optional<sip::TransformSpec> spec;            ///< of a recipe
};

/// The converged engine (401 bands) of a recipe.
/// @param config  where spaces that are not built in are looked up
ComparedTransform comparedRecipe(const sip::Recipe& recipe, const spectral::DataLibrary& library,
                                 const ConfigSource& config);

/// What a LUT file's pixels are, where no certificate beside it tells.
struct LutPixels {
  std::string space = "ACEScg";
  std::string shaper;  ///< curve of its signal over a linear space; empty: ACEScct for all but .ctf and .clf
};

/// A LUT file. Its certificate, FILE.json, tells what its pixels are; `pixels` where there is none.
/// @throws spectral::InputError: no such file, OCIO cannot read it, a certificate that is none
ComparedTransform comparedFile(const std::filesystem::path& file, const LutPixels& pixels,
                               const spectral::DataLibrary& library, const ConfigSource& config);

/// A look of a config, on linear ACES2065-1.
/// @param config  file, archive, or a name of OCIO's own (ocio://default)
/// @throws spectral::InputError: OCIO cannot load the config, no role aces_interchange, no such look (near names)
ComparedTransform comparedLook(const std::string& config, const std::string& look,
                               const spectral::DataLibrary& library);

/// `transform` on linear pixels of another space.
ComparedTransform onSpace(const ComparedTransform& transform, const spectral::RgbSpace& space,
                          const spectral::DataLibrary& library);

/// The linear space to compare two transforms in: a recipe's before a LUT file's before a look's.
const spectral::RgbSpace& comparisonSpace(const ComparedTransform& a, const ComparedTransform& b);

/// The error protocol's probes for two transforms: of the recipe where one is one (the first), else of a D65 pipeline
/// in `space`; over the exposures and gamut that both are made for.
/// @param space  linear; both transforms are on it
sip::Comparison compareTransforms(const ComparedTransform& a, const ComparedTransform& b,
                                  const spectral::RgbSpace& space, const spectral::DataLibrary& library);

}  // namespace metamer::ocio
