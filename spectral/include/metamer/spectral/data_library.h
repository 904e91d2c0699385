// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "metamer/spectral/colour_space.h"
#include "metamer/spectral/observer.h"
#include "metamer/spectral/pixel_set.h"
#include "metamer/spectral/spectral_picture.h"
#include "metamer/spectral/spectrum.h"

namespace metamer::spectral {

/// Spectra of one chart or sample set, all reflectances.
struct ReflectanceSet {
  std::string name;
  std::vector<Spectrum> samples;
};

/// Where a named or read spectrum came from: for certificates.
struct Provenance {
  std::string name;     ///< as the user gave it
  std::string file;     ///< table of data/ (relative) or the file as given; empty for a formula (blackbody)
  std::string sha256;   ///< of that table as its manifest states it; empty for a user's own file or a formula
  std::string source;   ///< citation
  std::string licence;  ///< SPDX identifier where there is one
};

/// What a name is: data/words.json.
struct NameDescription {
  std::string text;                ///< a sentence; empty where none is known
  std::vector<std::string> words;  ///< that people use for it: "sodium", "tungsten", "CTO"
};

/// The measured tables of data/, read on demand. Immutable and safe to share between threads.
///
/// Names are matched without regard to case. A NAME is looked up in the tables first; text with a path separator or
/// an extension that readSpectralFile takes is a file, relative to `baseFolder`; FILE:COLUMN is one curve of it. A
/// program that reads pictures gives its reader on opening: then spectral .exr are such files.
class DataLibrary {
 public:
  /// Opens a data folder by its manifest.json.
  /// @throws InputError: no manifest, another version, a table without unit or licence
  static DataLibrary open(const std::filesystem::path& folder, PictureChannelReader pictures = {});

  /// Finds the data folder: $METAMER_DATA, else ../share/metamer/data beside the running program's folder.
  /// @throws InputError naming both places
  static DataLibrary openDefault(PictureChannelReader pictures = {});

  /// Names a user can give, in table order.
  std::vector<std::string> illuminantNames() const;
  std::vector<std::string> observerNames() const;
  std::vector<std::string> filterNames() const;
  std::vector<std::string> reflectanceSetNames() const;
  std::vector<ColourSpace> colourSpaces() const;

  /// "D65", "HP1", ...; "3200 K" is a blackbody, "daylight 5600 K" a CIE daylight; or a file.
  /// @throws InputError: an unknown name lists the nearest ones
  Spectrum illuminant(const std::string& nameOrFile, const std::filesystem::path& baseFolder = {}) const;
  Observer observer(const std::string& nameOrFile, const std::filesystem::path& baseFolder = {}) const;
  Spectrum filter(const std::string& nameOrFile, const std::filesystem::path& baseFolder = {}) const;
  ReflectanceSet reflectances(const std::string& nameOrFile, const std::filesystem::path& baseFolder = {}) const;
  ColourSpace colourSpace(const std::string& name) const;

  /// The colours by which certificates judge files.
  std::vector<SetPixel> certificatePixels() const;

  /// Decadic molar extinction, in 1/cm per mol/L, of a substance that colours skin: "oxyhaemoglobin",
  /// "deoxyhaemoglobin" (both of the tetramer), "bilirubin", "beta-carotene". Zero outside its table.
  /// @throws InputError for any other name (lists these)
  Spectrum chromophore(const std::string& name) const;
  /// The table of how the skin model's parameters are distributed, for the library that has the model.
  std::filesystem::path skinPriorFile() const;

  /// What a name of a group ("illuminants", "observers", "filters") is, and words for it.
  NameDescription description(const std::string& group, const std::string& name) const;
  /// The names of a group that a text finds: all its words stand in the name, its description or its words, without
  /// regard to case. In table order.
  std::vector<std::string> namesFound(const std::string& group, const std::string& text) const;

  /// The reader that it was opened with, for readSpectralFile and its kin; empty without one.
  const PictureChannelReader& pictures() const;

  /// Provenance of a name as the calls above resolve it. `group` is the manifest's ("illuminants", ...).
  Provenance provenance(const std::string& group, const std::string& nameOrFile) const;

 private:
  struct State;
  explicit DataLibrary(std::shared_ptr<const State> state);
  std::shared_ptr<const State> m_state;
};

}  // namespace metamer::spectral
