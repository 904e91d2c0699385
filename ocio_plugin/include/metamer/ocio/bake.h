// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "metamer/ocio/certificate.h"
#include "metamer/ocio/config_source.h"
#include "metamer/ocio/lut_writer.h"
#include "metamer/ocio/representation.h"
#include "metamer/ocio/shaper.h"
#include "metamer/sip/recipe.h"
#include "metamer/spectral/data_library.h"

namespace metamer::ocio {

struct BakeOptions {
  /// Empty: Identity where the recipe does nothing, else what the format holds best.
  std::optional<Representation> representation = {};
  /// Nodes along a side, kSmallestTable ... kLargestTable (log_cube.h); 0: 65 for a chain and for .clf, 33 for other
  /// cubes. The most, where there is a tolerance.
  int size = 0;
  bool fitted = true;                 ///< tables solved for least error; false: the transform's values
  std::optional<Shaper> shaper = {};  ///< of cubes of a linear space; empty: ACEScct. A display's not for .ctf and .clf
  ConfigSource config = {};           ///< where spaces that are not built in are looked up
  /// 99th percentile of CIEDE2000 to hold, over the gamut and exposures that the certificate states, with the cheapest
  /// that does: nothing, a matrix, a table of few nodes, of more. Above 0; not together with `representation`.
  std::optional<double> tolerance = {};
  /// Exposures to judge by, stops round Y = 0.18, rising, -24 ... 24. Empty: -10 ... +10; for tables of a log signal,
  /// -7 ... +7 or as far as the signal goes.
  std::optional<int> lowestStop = {};
  std::optional<int> highestStop = {};
  /// Probes four times as many, and the error on measured surfaces whose spectra are known, left out set by set, beside
  /// plain adaptation's and a root polynomial's: about a second more.
  bool fullCertificate = false;
  /// Entries of the curve in front of a table, in formats that have one, as lutText() takes them; 0: their usual
  /// number.
  int shaperSize = 0;
  /// Told the share of the work that is done, 0 ... 1, rising, after every step of some seconds.
  std::function<void(double share)> progress = {};
};

/// A recipe as an OCIO transform.
struct Baked {
  OCIO::ConstGroupTransformRcPtr group;
  Certificate certificate;
};

/// A recipe as an OCIO transform on pixels of its space, with its measured error.
/// @throws spectral::InputError: what the recipe names is not there or has no meaning, a size out of range, a tolerance
///         that nothing holds
Baked bake(const sip::Recipe& recipe, const spectral::DataLibrary& library, const BakeOptions& options = {});

/// Bakes a recipe to a LUT file and its certificate beside it, FILE.json; the error is measured on the written file.
/// Either both files appear or none. A device, a pipe or a stream has no certificate beside it.
/// @param formatName  as lutFormat() takes it
/// @throws spectral::InputError as above, and where the file cannot be written
Certificate bakeFile(const sip::Recipe& recipe, const spectral::DataLibrary& library, const std::filesystem::path& file,
                     const std::string& formatName = {}, const BakeOptions& options = {});

/// The same as text, without any file. @param formatName  as lutFormat() takes it; needed
struct BakedText {
  std::string text;
  Certificate certificate;
};
BakedText bakeText(const sip::Recipe& recipe, const spectral::DataLibrary& library, const std::string& formatName,
                   const BakeOptions& options = {});

/// LUT files, one after the other, as one file of another format: no recipe, so no certificate.
/// @param luts  at least one
/// @param size  nodes along a side where the format holds a table, as BakeOptions; 0: 33
/// @param shaperSize  as BakeOptions
/// @throws spectral::InputError outside these, and where OCIO cannot read one, or the format cannot hold them
std::string convertedLuts(const std::vector<std::filesystem::path>& luts, const LutFormat& format, int size,
                          int shaperSize);

}  // namespace metamer::ocio
