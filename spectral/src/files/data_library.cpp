// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/data_library.h"

#include <algorithm>
#include <deque>
#include <mutex>
#include <optional>
#include <string_view>
#include <utility>

#include "files/csv_reader.h"
#include "files/data_manifest.h"
#include "files/data_words.h"
#include "metamer/spectral/illuminants.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/near_names.h"
#include "metamer/spectral/observer_of_curves.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/platform.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/text.h"

namespace metamer::spectral {
namespace {

/// A table with its spectra, read once when they are first asked for.
class LoadedTable {
 public:
  LoadedTable(const std::filesystem::path& folder, ManifestTable description)
      : m_file(folder / pathOf(description.file)), m_description(std::move(description)) {}

  const ManifestTable& description() const { return m_description; }
  const std::filesystem::path& file() const { return m_file; }

  /// Safe from several threads. A failed read throws and is tried again by the next call.
  const std::vector<Spectrum>& spectra() const {
    // Not call_once: under the thread sanitizer and some C++ libraries it hangs once a call has thrown.
    const std::lock_guard lock(m_mutex);
    if (!m_spectra) {
      m_spectra = read();
    }
    return *m_spectra;
  }

 private:
  std::vector<Spectrum> read() const {
    const std::string where = utf8(m_file);
    std::vector<Spectrum> spectra =
        readCsvOfScale(readTextFile(m_file), where, m_description.quantity, StatedScale::Unity);
    const std::string& group = m_description.group;
    const bool oneNameEach =
        group == "illuminants" || group == "filters" || group == "daylight_basis" || group == "chromophores";
    const std::size_t needed = oneNameEach ? m_description.names.size() : group == "observers" ? 3 : spectra.size();
    if (spectra.size() != needed) {
      throw InputError(where, "columns", std::to_string(spectra.size() + 1),
                       "the manifest needs " + std::to_string(needed + 1));
    }
    // Notes are for who reads a file; what these tables are stands in the manifest.
    for (Spectrum& spectrum : spectra) {
      spectrum = spectrum.withNotes({});
    }
    return spectra;
  }

  std::filesystem::path m_file;
  ManifestTable m_description;
  mutable std::mutex m_mutex;
  mutable std::optional<std::vector<Spectrum>> m_spectra;
};

/// Where a name stands.
struct Place {
  const LoadedTable* table;
  std::size_t index;  ///< among the table's names
};

/// "3200 K" or "3200K" as 3200.
std::optional<double> kelvin(std::string_view text) {
  text = trimmed(text);
  if (text.size() < 2 || (text.back() != 'K' && text.back() != 'k')) {
    return std::nullopt;
  }
  text.remove_suffix(1);
  return parseNumber(text);
}

/// "daylight 5600 K" as 5600.
std::optional<double> daylightKelvin(const std::string& name) {
  constexpr std::string_view kPrefix = "daylight ";
  return lowerCase(name.substr(0, kPrefix.size())) == kPrefix ? kelvin(std::string_view(name).substr(kPrefix.size()))
                                                              : std::nullopt;
}

/// The one spectrum of a user's file.
Spectrum onlySpectrum(std::vector<Spectrum> spectra, const std::string& file) {
  if (spectra.size() != 1) {
    throw InputError(file, "columns", std::to_string(spectra.size()),
                     "are several curves; name one as FILE:COLUMN, of: " + columnsText(spectra));
  }
  return std::move(spectra.front());
}

Observer makeObserver(std::string name, Observer::Response response, const std::vector<Spectrum>& curves,
                      std::optional<Eigen::Matrix3d> xyzFromResponse) {
  if (response == Observer::Response::Xyz) {
    xyzFromResponse = Eigen::Matrix3d::Identity();
  }
  return {std::move(name), response, {curves[0], curves[1], curves[2]}, xyzFromResponse};
}

std::string listCommand(const std::string& group) {
  return "lutgen list " + (group == "rgb_spaces" ? std::string("spaces") : group);
}

std::string singular(const std::string& group) {
  if (group == "rgb_spaces") {
    return "space";
  }
  return group == "reflectances" ? "reflectance set" : group.substr(0, group.size() - 1);
}

}  // namespace

struct DataLibrary::State {
  std::filesystem::path folder;
  PictureChannelReader pictures;
  /// A deque, because a table's mutex cannot move.
  std::deque<LoadedTable> tables;
  DataWords words;

  std::vector<std::string> namesFound(const std::string& group, const std::string& text) const {
    std::vector<std::string> found;
    for (const std::string& name : namesOf(group)) {
      if (words.isFound(group, name, text)) {
        found.push_back(name);
      }
    }
    return found;
  }

  std::vector<std::string> namesOf(const std::string& group) const {
    std::vector<std::string> names;
    for (const LoadedTable& table : tables) {
      const ManifestTable& description = table.description();
      if (description.group == group) {
        names.insert(names.end(), description.names.begin(), description.names.end());
      }
    }
    return names;
  }

  std::optional<Place> find(const std::string& group, const std::string& name) const {
    const std::string wanted = lowerCase(trimmed(name));
    for (const LoadedTable& table : tables) {
      const std::vector<std::string>& names = table.description().names;
      for (std::size_t i = 0; table.description().group == group && i < names.size(); ++i) {
        if (lowerCase(names[i]) == wanted) {
          return Place{&table, i};
        }
      }
    }
    return std::nullopt;
  }

  const LoadedTable& onlyTable(const std::string& group) const {
    const auto table = std::find_if(tables.begin(), tables.end(),
                                    [&](const LoadedTable& t) { return t.description().group == group; });
    if (table == tables.end()) {
      throw InputError(utf8(folder / "manifest.json"), "group", group,
                       "is missing; use the data folder of this release");
    }
    return *table;
  }

  [[noreturn]] void throwUnknown(const std::string& group, const std::string& name) const {
    constexpr std::size_t kMost = 8;
    std::vector<std::string> found;
    for (const std::string& known : namesOf(group)) {
      if (words.isWordFor(group, known, name)) {
        found.push_back(known);
      }
    }
    if (found.empty()) {
      throw InputError("", singular(group), name, unknownNameRemedy(name, namesOf(group), listCommand(group)));
    }
    const bool areMore = found.size() > kMost;
    found.resize(std::min(found.size(), kMost));
    throw InputError("", singular(group), name,
                     "is no name, but a word for: " + joined(found) + (areMore ? ", ..." : "") +
                         "; see: " + listCommand(group) + " " + lowerCase(trimmed(name)));
  }

  /// The spectra of a file that the user named, or no value where the text names no file.
  std::optional<std::vector<Spectrum>> fromFile(const std::string& name, const std::filesystem::path& baseFolder,
                                                SpectralQuantity quantity) const {
    if (!looksLikeSpectralFile(name)) {
      return std::nullopt;
    }
    return readSpectralFile(baseFolder / pathOf(name), quantity, pictures);
  }

  /// The spectrum of a table that has a name a column.
  std::optional<Spectrum> column(const std::string& group, const std::string& name) const {
    const std::optional<Place> place = find(group, name);
    return place ? std::optional(place->table->spectra()[place->index]) : std::nullopt;
  }

  static std::shared_ptr<State> read(const std::filesystem::path& folder, PictureChannelReader pictures) {
    auto state = std::make_shared<State>();
    state->folder = folder;
    state->pictures = std::move(pictures);
    for (ManifestTable& table : readManifest(folder)) {
      state->tables.emplace_back(folder, std::move(table));
    }
    state->words = readWords(folder);
    return state;
  }
};

DataLibrary::DataLibrary(std::shared_ptr<const State> state) : m_state(std::move(state)) {}

DataLibrary DataLibrary::open(const std::filesystem::path& folder, PictureChannelReader pictures) {
  return DataLibrary(State::read(folder, std::move(pictures)));
}

DataLibrary DataLibrary::openDefault(PictureChannelReader pictures) {
  const std::filesystem::path named = pathOf(environmentValue("METAMER_DATA").value_or(""));
  const std::filesystem::path beside = programFolder().parent_path() / "share" / "metamer" / "data";
  std::error_code error;
  for (const std::filesystem::path& folder : {named, beside}) {
    if (!folder.empty() && std::filesystem::exists(folder / "manifest.json", error)) {
      return open(folder, std::move(pictures));
    }
    // A folder that somebody named is not passed over in silence.
    if (!folder.empty() && folder == named) {
      break;
    }
  }
  throw InputError("data folder", "METAMER_DATA", utf8(named),
                   "no manifest.json there or in " + utf8(beside) + "; set METAMER_DATA to metamer's data folder");
}

const PictureChannelReader& DataLibrary::pictures() const {
  return m_state->pictures;
}

std::vector<std::string> DataLibrary::illuminantNames() const {
  return m_state->namesOf("illuminants");
}
std::vector<std::string> DataLibrary::observerNames() const {
  return m_state->namesOf("observers");
}
std::vector<std::string> DataLibrary::filterNames() const {
  return m_state->namesOf("filters");
}
std::vector<std::string> DataLibrary::reflectanceSetNames() const {
  return m_state->namesOf("reflectances");
}

std::vector<ColourSpace> DataLibrary::colourSpaces() const {
  return spectral::colourSpaces(readRgbSpaces(m_state->onlyTable("rgb_spaces").file()));
}

std::vector<SetPixel> DataLibrary::certificatePixels() const {
  return readPixelSet(m_state->onlyTable("pixels").file());
}

Spectrum DataLibrary::illuminant(const std::string& nameOrFile, const std::filesystem::path& baseFolder) const {
  if (std::optional<Spectrum> found = m_state->column("illuminants", nameOrFile)) {
    return *std::move(found);
  }
  if (const std::optional<double> temperature = kelvin(nameOrFile)) {
    return blackbody(*temperature);
  }
  if (const std::optional<double> temperature = daylightKelvin(nameOrFile)) {
    return daylight(*temperature, m_state->onlyTable("daylight_basis").spectra());
  }
  if (auto spectra = m_state->fromFile(nameOrFile, baseFolder, SpectralQuantity::SpectralPowerDistribution)) {
    return onlySpectrum(*std::move(spectra), utf8(baseFolder / pathOf(nameOrFile)));
  }
  m_state->throwUnknown("illuminants", nameOrFile);
}

Observer DataLibrary::observer(const std::string& nameOrFile, const std::filesystem::path& baseFolder) const {
  if (const std::optional<Place> place = m_state->find("observers", nameOrFile)) {
    const ManifestTable& table = place->table->description();
    return makeObserver(table.names.front(), table.response, place->table->spectra(), table.xyzFromResponse);
  }
  if (const auto curves = m_state->fromFile(nameOrFile, baseFolder, SpectralQuantity::Sensitivity)) {
    if (curves->size() != 3) {
      throw InputError(utf8(baseFolder / pathOf(nameOrFile)), "columns", std::to_string(curves->size() + 1),
                       "must be 4, a wavelength and three responses");
    }
    return observerOfCurves(nameOrFile, *curves);
  }
  m_state->throwUnknown("observers", nameOrFile);
}

Spectrum DataLibrary::filter(const std::string& nameOrFile, const std::filesystem::path& baseFolder) const {
  if (std::optional<Spectrum> found = m_state->column("filters", nameOrFile)) {
    return *std::move(found);
  }
  if (auto spectra = m_state->fromFile(nameOrFile, baseFolder, SpectralQuantity::Transmittance)) {
    return onlySpectrum(*std::move(spectra), utf8(baseFolder / pathOf(nameOrFile)));
  }
  m_state->throwUnknown("filters", nameOrFile);
}

ReflectanceSet DataLibrary::reflectances(const std::string& nameOrFile, const std::filesystem::path& baseFolder) const {
  if (const std::optional<Place> place = m_state->find("reflectances", nameOrFile)) {
    return {place->table->description().names.front(), place->table->spectra()};
  }
  if (auto spectra = m_state->fromFile(nameOrFile, baseFolder, SpectralQuantity::Reflectance)) {
    return {nameOrFile, *std::move(spectra)};
  }
  m_state->throwUnknown("reflectances", nameOrFile);
}

ColourSpace DataLibrary::colourSpace(const std::string& name) const {
  const std::string wanted = lowerCase(trimmed(name));
  std::vector<std::string> names;
  for (ColourSpace& space : colourSpaces()) {
    if (lowerCase(space.name) == wanted) {
      return std::move(space);
    }
    names.push_back(std::move(space.name));
  }
  throw InputError("", "space", name, unknownNameRemedy(name, names, listCommand("rgb_spaces")));
}

Spectrum DataLibrary::chromophore(const std::string& name) const {
  if (std::optional<Spectrum> found = m_state->column("chromophores", name)) {
    return *std::move(found);
  }
  throw InputError("", "chromophore", name, "must be one of: " + joined(m_state->namesOf("chromophores")));
}

std::filesystem::path DataLibrary::skinPriorFile() const {
  return m_state->onlyTable("skin_prior").file();
}

NameDescription DataLibrary::description(const std::string& group, const std::string& name) const {
  return m_state->words.of(group, name);
}

std::vector<std::string> DataLibrary::namesFound(const std::string& group, const std::string& text) const {
  return m_state->namesFound(group, text);
}

Provenance DataLibrary::provenance(const std::string& group, const std::string& nameOrFile) const {
  const auto ofTable = [&](const ManifestTable& table) {
    return Provenance{nameOrFile, table.file, table.sha256, table.source, table.licence};
  };
  if (group == "rgb_spaces") {
    colourSpace(nameOrFile);
    return ofTable(m_state->onlyTable(group).description());
  }
  if (const std::optional<Place> place = m_state->find(group, nameOrFile)) {
    return ofTable(place->table->description());
  }
  if (group == "illuminants" && kelvin(nameOrFile)) {
    return {nameOrFile, "", "", "Planck's law with the CODATA 2018 constants", ""};
  }
  if (group == "illuminants" && daylightKelvin(nameOrFile)) {
    return ofTable(m_state->onlyTable("daylight_basis").description());
  }
  if (looksLikeSpectralFile(nameOrFile)) {
    return {nameOrFile, spectralFileName(nameOrFile).file, "", "", ""};
  }
  m_state->throwUnknown(group, nameOrFile);
}

}  // namespace metamer::spectral
