// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/config_document.h"
#include "config/config_items.h"
#include "metamer/ocio/bake.h"

namespace metamer::ocio {

/// A recipe of a core, and the pixels that its named transform is for.
struct CoreUse {
  sip::Recipe recipe;
  std::string pixelSpace;
  std::string encoding;  ///< of pixelSpace; empty where it is not known
};

/// Recipes that differ in nothing but name and adaptation. The eye's adaptation is a gain on the cones of what the
/// output pipeline sees: from one to another it is a matrix behind the transform, so one table serves all.
struct ConfigCore {
  std::string name;          ///< of its file
  sip::Recipe recipe;        ///< as it is baked: on linear pixels, with the middle adaptation of its uses
  std::string processSpace;  ///< of the looks
  std::optional<Eigen::Matrix3d> linearFromProcess;  ///< where that is not the space of `recipe`
  std::vector<CoreUse> uses;
};

/// @throws spectral::InputError: a space that is neither built in nor the config's, or holds data
std::vector<ConfigCore> coresOf(const std::vector<sip::Recipe>& recipes, const ConfigFacts& facts,
                                const spectral::DataLibrary& library, const std::string& where);

struct BakedCore {
  OCIO::ConstGroupTransformRcPtr group;
  Certificate certificate;
  std::string lutText;  ///< of its .ctf; empty where it is matrices alone
};
/// Neutrals come out of the file as they come out of the engine.
/// @param size, tolerance  as ConfigOptions
/// @param folder           for a file to try
BakedCore bakeCore(const ConfigCore& core, const spectral::DataLibrary& library, int size,
                   std::optional<double> tolerance, const std::filesystem::path& folder);

/// What the look of a use does in the core's process space.
/// @param src  how the config names the core's file
std::vector<ConfigStep> stepsOf(const ConfigCore& core, const CoreUse& use, const BakedCore& baked,
                                const std::string& src, const spectral::DataLibrary& library);

/// The certificate of a use, measured through the written file.
/// @param lutFile  where the core's file is now; empty where it has none
Certificate certificateOf(const ConfigCore& core, const CoreUse& use, const BakedCore& baked,
                          const std::filesystem::path& lutFile, const spectral::DataLibrary& library);

}  // namespace metamer::ocio
