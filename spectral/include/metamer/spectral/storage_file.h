// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "metamer/spectral/storage.h"

namespace metamer::spectral {

/// Spectra that are stored in one form, each with its name.
struct StoredSet {
  struct Entry {
    std::string name;
    StoredSpectrum spectrum;
  };
  StorageForm form = StorageForm::Points;
  bool isLight = false;
  std::vector<Entry> entries;
};

/// JSON: {"metamer_storage": 1, "form": "hats", "use": "reflectance", "spectra": [{"name": "...", "numbers": [...]}]};
/// "use" may be "light"; "lines" says how many of a light's last pairs of numbers are lines. Numbers have the digits
/// that bring each float back.
std::string storageText(const StoredSet& set);

/// @throws InputError: not there, no JSON, another version, a field that is missing or of the wrong kind
StoredSet readStorage(const std::filesystem::path& file);

}  // namespace metamer::spectral
