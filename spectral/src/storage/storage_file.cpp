// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/storage_file.h"

#include "files/json_text.h"
#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_files.h"

namespace metamer::spectral {
namespace {

constexpr const char* kMadeBy = "must be as lutgen spectrum pack writes it";
/// Lines come back from text with all of a float's bits.
constexpr const char* kWholeFloat = "%.9g";

StoredSet::Entry entryOf(const nlohmann::json& json, const StoredSet& set, const std::string& where) {
  StoredSet::Entry entry{requiredText(json, "name", where), {set.form, set.isLight, 0, {}}};
  const nlohmann::json& numbers = member(json, "numbers");
  if (!numbers.is_array() || numbers.size() > kMostStored) {
    throw InputError(where, entry.name + ".numbers", valueText(numbers), kMadeBy);
  }
  for (const nlohmann::json& number : numbers) {
    if (!number.is_number()) {
      throw InputError(where, entry.name + ".numbers", valueText(number), "must be a number");
    }
    entry.spectrum.numbers.push_back(number.get<float>());
  }
  if (const nlohmann::json& lines = member(json, "lines"); !lines.is_null()) {
    if (!lines.is_number_unsigned() || lines.get<std::uint64_t>() > kMostStored / 2) {
      throw InputError(where, entry.name + ".lines", valueText(lines), kMadeBy);
    }
    entry.spectrum.lines = lines.get<int>();
  }
  return entry;
}

}  // namespace

std::string storageText(const StoredSet& set) {
  std::string text = "{\"metamer_storage\": 1, \"form\": \"" + storageFormNames()[static_cast<std::size_t>(set.form)] +
                     "\", \"use\": \"" + (set.isLight ? "light" : "reflectance") + "\", \"spectra\": [";
  const char* between = "\n";
  for (const StoredSet::Entry& entry : set.entries) {
    text += between + std::string("  {\"name\": ") +
            nlohmann::json(entry.name).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    text += entry.spectrum.lines > 0 ? ", \"lines\": " + std::to_string(entry.spectrum.lines) : "";
    text += ", \"numbers\": [";
    for (std::size_t k = 0; k < entry.spectrum.numbers.size(); ++k) {
      text += (k > 0 ? ", " : "") + formatted(kWholeFloat, static_cast<double>(entry.spectrum.numbers[k]));
    }
    text += "]}";
    between = ",\n";
  }
  return text + "\n]}\n";
}

StoredSet readStorage(const std::filesystem::path& file) {
  const std::string where = utf8(file);
  const nlohmann::json json = parseJson(readTextFile(file), where);
  if (const nlohmann::json& version = member(json, "metamer_storage"); version != 1) {
    throw InputError(where, "metamer_storage", valueText(version), "must be 1, " + std::string(kMadeBy));
  }
  StoredSet set;
  try {
    set.form = storageFormNamed(requiredText(json, "form", where));
  } catch (const InputError& error) {
    throw InputError(where, "", "", error.what());
  }
  const std::string use = requiredText(json, "use", where);
  if (use != "light" && use != "reflectance") {
    throw InputError(where, "use", use, "must be light or reflectance");
  }
  set.isLight = use == "light";
  const nlohmann::json& spectra = member(json, "spectra");
  if (!spectra.is_array() || spectra.empty()) {
    throw InputError(where, "spectra", valueText(spectra), kMadeBy);
  }
  for (const nlohmann::json& entry : spectra) {
    set.entries.push_back(entryOf(entry, set, where));
  }
  return set;
}

}  // namespace metamer::spectral
