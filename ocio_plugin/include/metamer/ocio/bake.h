// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include <filesystem>
#include <optional>

#include "metamer/ocio/certificate.h"
#include "metamer/ocio/lut_writer.h"
#include "metamer/ocio/representation.h"
#include "metamer/sip/recipe.h"
#include "metamer/spectral/data_library.h"

namespace metamer::ocio {

struct BakeOptions {
  /// Empty: Identity where the recipe does nothing, else what the format holds best.
  std::optional<Representation> representation;
  int size = 0;                                 ///< nodes along a side; 0: 65 for a chain, 33 for a cube
  bool fitted = true;                           ///< tables solved for least error; false: the transform's values
  std::optional<spectral::LogEncoding> shaper;  ///< of cubes of a linear space; empty: ACEScct
  OCIO::ConstConfigRcPtr config;                ///< where spaces that are not built in are looked up; may be null
};

/// A recipe as an OCIO transform.
struct Baked {
  OCIO::ConstGroupTransformRcPtr group;
  Certificate certificate;
};

/// A recipe as an OCIO transform on pixels of its space, with its measured error.
/// @throws spectral::InputError: what the recipe names is not there or has no meaning, a size out of range
Baked bake(const sip::Recipe& recipe, const spectral::DataLibrary& library, const BakeOptions& options = {});

/// Bakes a recipe to a LUT file and its certificate beside it, FILE.json; the error is measured on the written file.
/// Either both files appear or none.
/// @param formatName  as lutFormat() takes it
/// @throws spectral::InputError as above, and where the file cannot be written
Certificate bakeFile(const sip::Recipe& recipe, const spectral::DataLibrary& library, const std::filesystem::path& file,
                     const std::string& formatName = {}, const BakeOptions& options = {});

}  // namespace metamer::ocio
