// SPDX-License-Identifier: Apache-2.0
#include "config/config_base.h"

#include <algorithm>
#include <sstream>

#include "metamer/ocio/config_source.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/text.h"
#include "operators/interchange.h"

namespace metamer::ocio {
namespace {

using spectral::InputError;
namespace fs = std::filesystem;

fs::path folderOf(const fs::path& file) {
  return fs::absolute(file).lexically_normal().parent_path();
}

bool hasVariable(const std::string& text) {
  return text.find_first_of("$%") != std::string::npos;
}

bool isThere(const fs::path& file) {
  std::error_code none;
  return fs::is_regular_file(file, none);
}

/// Whether a config in a folder finds a file, as OCIO looks for it; true where variables decide.
bool isFound(const std::string& src, const ConfigFacts& facts, const fs::path& folder) {
  if (hasVariable(src) || std::any_of(facts.searchPath.begin(), facts.searchPath.end(), hasVariable)) {
    return true;
  }
  if (spectral::pathOf(src).is_absolute() || facts.searchPath.empty()) {
    return isThere(folder / spectral::pathOf(src));
  }
  return std::any_of(facts.searchPath.begin(), facts.searchPath.end(), [&](const std::string& path) {
    return isThere(folder / spectral::pathOf(path) / spectral::pathOf(src));
  });
}

/// A base's own text; of one of OCIO's own configs, as OCIO writes it.
std::string textOf(const fs::path& base) {
  if (isBuiltInConfig(spectral::utf8(base))) {
    std::ostringstream text;
    configNamed(spectral::utf8(base))->serialize(text);
    return std::move(text).str();
  }
  if (base.extension() == ".ocioz") {
    throw InputError(spectral::utf8(base), "base", "", "is an archive; unpack it first: ocioarchive --extract");
  }
  return spectral::readTextFile(base);
}

bool isHere(const std::string& folder) {
  return folder == "." || folder == "./";
}

}  // namespace

ConfigDocument openBaseConfig(const fs::path& base, const fs::path& result) {
  ConfigDocument document(textOf(base), spectral::utf8(base));
  const ConfigFacts& facts = document.facts();
  if (facts.majorVersion < 2) {
    throw InputError(spectral::utf8(base), "ocio_profile_version", std::to_string(facts.majorVersion),
                     "knows no named transforms, and its programs none of the operators of a look; upgrade the config "
                     "to version 2 first (OCIO's Config::upgradeToLatestVersion) and give it the role " +
                         std::string(kInterchangeRole));
  }
  const auto role = facts.roles.find(kInterchangeRole);
  if (role == facts.roles.end()) {
    throw InputError(
        spectral::utf8(base), "role", kInterchangeRole,
        "is missing; add it to the roles: it names the config's ACES2065-1, which tells what its spaces are");
  }
  if (!facts.space(role->second)) {
    throw InputError(spectral::utf8(base), "role", kInterchangeRole,
                     "names '" + role->second + "', which the config does not have; mend the role");
  }
  for (const std::string& src : facts.files) {
    if (!isFound(src, facts, folderOf(base))) {
      throw InputError(spectral::utf8(base), "src", src,
                       "is not in the search path; put the file back or mend the config");
    }
    if (!isFound(src, facts, folderOf(result))) {
      throw InputError(spectral::utf8(base), "src", src,
                       "is found from the base's own folder only; write the result there: -o " +
                           spectral::utf8(base.parent_path() / result.filename()));
    }
  }
  return document;
}

LutPlace placeOfLuts(const ConfigFacts& facts, const std::string& folder) {
  const auto& path = facts.searchPath;
  if (std::any_of(path.begin(), path.end(), isHere)) {
    return {folder + "/", ""};
  }
  // Without a search path, files are looked for beside the config; with one, there no more.
  if (path.empty() && !facts.files.empty()) {
    return {folder + "/", "."};
  }
  const bool isListed = std::any_of(path.begin(), path.end(), [&](const std::string& entry) {
    return spectral::pathOf(entry).lexically_normal() == spectral::pathOf(folder) ||
           spectral::pathOf(entry).lexically_normal() == spectral::pathOf(folder + "/");
  });
  return {"", isListed ? "" : folder};
}

void refuseShadows(const ConfigFacts& facts, const std::string& src, const std::string& lutFolder,
                   const fs::path& result) {
  for (const std::string& entry : facts.searchPath) {
    const fs::path folder = (folderOf(result) / spectral::pathOf(entry)).lexically_normal();
    const fs::path found = folder / spectral::pathOf(src);
    if (isThere(found) && found.lexically_normal() !=
                              (folderOf(result) / spectral::pathOf(lutFolder) / spectral::pathOf(src).filename())) {
      throw InputError(spectral::utf8(result), "search_path", entry,
                       "has a file " + src + " already, which the config would find first; rename the recipe");
    }
  }
}

}  // namespace metamer::ocio
