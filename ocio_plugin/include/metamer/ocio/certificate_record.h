// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "metamer/sip/recipe.h"
#include "metamer/spectral/data_library.h"

namespace metamer::ocio {

/// A certificate that was written, read again.
struct CertificateRecord {
  std::string where;    ///< what messages call it
  std::string text;     ///< the whole JSON
  std::string version;  ///< of the metamer that wrote it
  double mean = 0;      ///< CIEDE2000 against the converged engine, finite
  double p99 = 0;
  double max = 0;
  std::string sha256;  ///< of the file that it is for; empty for a transform that is not a file
};

/// @throws spectral::InputError: no JSON, no certificate, an error that is no number
CertificateRecord certificateFrom(const std::string& text, const std::string& where);
/// @throws spectral::InputError as above, and where it cannot be read
CertificateRecord readCertificate(const std::filesystem::path& file);

/// One thing that two certificates say differently.
struct CertificateChange {
  std::string part;    ///< "recipe", "inputs", "transform", "range", "error", "pixels", "diagnostics", "policy", ...
  std::string field;   ///< "output.adaptation"; of inputs their role and field, "output.illuminant.sha256"
  std::string before;  ///< as JSON; empty where it is not there
  std::string after;
  std::string name;  ///< of an input: the table or file

  /// In plain words, one line: "recipe: output.adaptation was 0.0, is 0.5".
  std::string words() const;
};

/// All of them, in the order of the certificates' fields; inputs are told by their roles.
std::vector<CertificateChange> changesBetween(const CertificateRecord& before, const CertificateRecord& after);

/// What a certificate names and a recipe, its files as they are now and this program say differently: why a LUT may not
/// be what it was. @throws spectral::InputError where a file of the recipe cannot be read
std::vector<CertificateChange> staleParts(const CertificateRecord& certificate, const sip::Recipe& recipe,
                                          const spectral::DataLibrary& library);

}  // namespace metamer::ocio
