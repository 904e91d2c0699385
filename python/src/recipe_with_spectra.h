// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <map>
#include <optional>

#include "metamer/sip/recipe.h"
#include "metamer/spectral/data_library.h"

namespace metamer::python {

namespace nb = nanobind;

/// A recipe, some of whose lights, filters and observers are given as spectra in place of names.
struct RecipeWithSpectra {
  struct Side {
    std::optional<spectral::Spectrum> illuminant;
    std::map<std::size_t, spectral::Spectrum> filters;  ///< by their place among the named recipe's filters
    std::optional<spectral::Observer> observer;
  };
  sip::Recipe named;
  Side input;
  Side output;

  /// Whether names say it all: what files and certificates need.
  bool isNamed() const;
};

/// sip::resolve, with the given spectra in their places.
sip::TransformSpec resolve(const RecipeWithSpectra& recipe, const spectral::DataLibrary& library);

/// A Recipe, or one read from a file. @throws nb::type_error for any other object; spectral::InputError as readRecipe
RecipeWithSpectra recipeFrom(nb::handle object);

}  // namespace metamer::python
