// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "metamer/sip/homogeneous_map.h"
#include "metamer/sip/map_memory.h"
#include "metamer/sip/scene_cache.h"
#include "metamer/sip/spectral_transform.h"
#include "metamer/spectral/data_library.h"
#include "metamer/spectral/path_text.h"

namespace metamer::playground {

/// What a page works on: one recipe at a time, and what the recipes before it had to solve.
class Session {
 public:
  /// @param folder  of the measured tables
  explicit Session(const std::string& folder) : m_library(spectral::DataLibrary::open(spectral::pathOf(folder))) {}

  const spectral::DataLibrary& library() const { return m_library; }

  /// @param yaml  a recipe as docs/recipe.md has it. @throws spectral::InputError, and keeps the recipe before
  void setRecipe(const std::string& yaml);

  /// Of the recipe. @throws spectral::InputError where none was set
  const sip::TransformSpec& spec() const;
  const sip::SpectralTransform& transform() const;

  /// The recipe's transform in another working space.
  sip::SpectralTransform transformIn(const spectral::RgbSpace& space);

  /// The transform as a map: fast. Made where the one before was of another recipe or tolerance. From a tolerance of
  /// 100 on, a draft: 414 spectra, none of them solved to judge it.
  const sip::HomogeneousMap& map(double tolerance);

 private:
  struct Current {
    sip::TransformSpec spec;
    sip::SpectralTransform transform;
    std::optional<sip::HomogeneousMap> map = {};
    double tolerance = 0.0;
  };
  Current& current();
  const Current& current() const;

  spectral::DataLibrary m_library;
  sip::SceneCache m_scenes;
  sip::MapMemory m_memory;
  sip::MapMemory m_draftMemory;  ///< whose parts are others
  std::optional<Current> m_current;
};

}  // namespace metamer::playground
