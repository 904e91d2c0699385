// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "metamer/ocio/pixel_protocol.h"
#include "metamer/ocio/representation.h"
#include "metamer/sip/error_protocol.h"
#include "metamer/sip/held_out.h"
#include "metamer/sip/recipe.h"

namespace metamer::ocio {

/// One table or file that went into a transform.
struct CertifiedInput {
  std::string role;  ///< "input.illuminant", "output.filters[0]", ...
  spectral::Provenance provenance;
};

/// How a representation was chosen: the cheapest that holds a tolerance.
struct CertifiedChoice {
  struct Tried {
    Representation representation = Representation::Identity;
    int size = 0;
    double p99 = 0;
    double max = 0;
  };
  double tolerance = 0;      ///< on the 99th percentile
  std::vector<Tried> tried;  ///< from the cheapest; the last is the chosen one
};

/// What a written transform is, what it was made from, and how far it is from the converged engine. The same bytes for
/// the same transform: no times, no folders of this machine.
struct Certificate {
  sip::Recipe recipe;
  std::vector<CertifiedInput> inputs;
  std::vector<std::string> notes;  ///< what reading the inputs changed, and what they lack (sip::notesOf)
  Representation representation = Representation::Identity;
  std::string format;                     ///< OCIO's name of the file format; empty for a transform that is not a file
  std::optional<CertifiedChoice> choice;  ///< where there was a tolerance
  int size = 0;                           ///< nodes along a side of its table, 0 without one
  bool fitted = false;                    ///< whether the table's nodes are solved for least error
  bool negativesKept = true;              ///< whether a log cube's nodes may be signals below 0
  std::string shaper;                     ///< of a log cube; empty without one
  int shaperEntries = 0;                  ///< entries of the curve in front of a log cube's table, 0 without one
  int bandCount = 0;                      ///< of the engine that made it
  std::string gamut;                      ///< working space of the probes
  sip::ErrorProtocol::Options probes;
  /// CIEDE2000 against 401 bands, through OCIO's CPU processor; of a shader file through its kernel's text and the
  /// tables read from the file, compiled for the processor.
  sip::ErrorProtocol::Report error;
  /// Of a file that OCIO reads: the same through OCIO's shader for graphics cards, its tables as textures.
  struct OnCards {
    sip::ErrorProtocol::Report floats;
    sip::ErrorProtocol::Report halves;
  };
  std::optional<OnCards> onCards;
  PixelProtocol::Report pixels;  ///< against the engine that made it; of no pixels where it was not measured
  double brightening = 0;        ///< the engine's luminance out over in at saturated lights, over white's, at most
  sip::SpectralTransform::Diagnostics diagnostics;
  std::vector<sip::HeldOutSet>
      surfaces;        ///< against the truth, beside simpler transforms; empty where it was not asked
  double folds = 0;    ///< share of the probes where the map of chromaticities turns over (negative Jacobian)
  double gain = 0;     ///< largest singular value of the transform's derivative at the probes
  std::string sha256;  ///< of the written file; empty for a transform that is not a file

  /// The whole as JSON, fields in a fixed order, two spaces of indent, a newline at the end.
  std::string json() const;
  /// What a user is to be told at once, a sentence each: saturated lights that grow, pixels that end far off.
  std::vector<std::string> warnings() const;
  /// The heart of it for comments and metadata, one statement a line.
  std::vector<std::string> lines() const;
};

/// The inputs that a recipe names. The hash of a user's own file is computed here, that of a table is its manifest's.
std::vector<CertifiedInput> certifiedInputs(const sip::Recipe& recipe, const spectral::DataLibrary& library);

/// SHA-256 of bytes, lower-case hexadecimal.
std::string sha256(const std::string& bytes);

/// Version of this library, "0.2.0".
std::string toolVersion();

}  // namespace metamer::ocio
