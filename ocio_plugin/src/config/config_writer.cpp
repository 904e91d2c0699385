// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/config_writer.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <set>

#include "config/config_base.h"
#include "config/config_cores.h"
#include "config/config_document.h"
#include "config/config_items.h"
#include "config/config_loader.h"
#include "config/new_config.h"
#include "config/used_files.h"
#include "metamer/ocio/config_source.h"
#include "metamer/ocio/log_cube.h"
#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/spectral/pending_folder.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/text.h"

namespace metamer::ocio {
namespace {

using spectral::InputError;
namespace fs = std::filesystem;

/// OCIO takes lists of looks apart at these, and puts variables in for the last.
void checkName(const std::string& name, const std::string& where) {
  const bool hasControl = std::any_of(name.begin(), name.end(), [](unsigned char c) { return c < 0x20; });
  if (name.empty() || hasControl || name.find_first_of(",:|/\\%$+\"") != std::string::npos || name.front() == '-' ||
      name.front() == ' ' || name.back() == ' ') {
    throw InputError(where, "name", name,
                     "cannot be the name of a look: leave out , : | / \\ % $ + \" and a leading -");
  }
}

/// @return lower-case names of the looks and named transforms that give way
std::set<std::string> checkNames(const std::vector<sip::Recipe>& recipes, const ConfigFacts& facts,
                                 const std::string& where, bool replaces) {
  std::set<std::string> given;
  std::set<std::string> replaced;
  for (const sip::Recipe& recipe : recipes) {
    const std::string recipeFile = recipe.where.empty() ? "recipe" : recipe.where;
    checkName(recipe.name, recipeFile);
    const std::string look = spectral::lowerCase(recipe.name);
    const std::string named = spectral::lowerCase(namedTransformName(recipe.name));
    if (!given.insert(look).second) {
      throw InputError(recipeFile, "name", recipe.name, "is the name of another recipe too; give each its own");
    }
    if (facts.looks.count(look) != 0 && !replaces) {
      throw InputError(where, "look", recipe.name,
                       "is there already; rename the recipe, or renew the look with --replace");
    }
    if (replaces && facts.looks.count(look) != 0) {
      replaced.insert(look);
    }
    if (replaces && facts.namedTransforms.count(named) != 0) {
      replaced.insert(named);
    }
    // OCIO keeps looks and named transforms apart from each other and from everything that is converted.
    for (const std::string& taken : {recipe.name, namedTransformName(recipe.name)}) {
      const std::string lower = spectral::lowerCase(taken);
      if (replaced.count(lower) == 0 &&
          (facts.taken.count(lower) != 0 || (lower != look && facts.looks.count(lower) != 0))) {
        throw InputError(where, "name", taken,
                         "is that of a colour space, role, look or named transform of the config; rename the recipe");
      }
    }
  }
  return replaced;
}

/// A name as that of a file: letters, digits, dot, dash and underscore.
std::string fileName(const std::string& name) {
  std::string file;
  for (const char c : name) {
    const bool isPlain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
                         c == '-' || c == '_' || static_cast<unsigned char>(c) >= 0x80;
    file += isPlain ? c : '_';
  }
  return file.front() == '.' ? "_" + file : file;
}

/// A file that somebody else put there stays.
void refuseForeign(const fs::path& file, const std::string& mark) {
  std::ifstream stream(file, std::ios::binary);
  std::string head(512, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  if (stream.gcount() > 0 && head.find(mark) == std::string::npos) {
    throw InputError(spectral::utf8(file), "output", "", "is there and not metamer's; name another --lut-folder");
  }
}

std::string familyOf(const sip::Recipe& recipe, const std::string& family, char separator) {
  const auto filters = [](const sip::RecipePipeline& pipeline) {
    std::string text;
    for (const auto& filter : pipeline.filters) {
      text += filter.name + ":" + std::to_string(filter.density) + "\n";
    }
    return text;
  };
  std::string kind = "Scene";
  if (spectral::lowerCase(recipe.input.illuminant) != spectral::lowerCase(recipe.output.illuminant)) {
    const fs::path light = spectral::pathOf(recipe.input.illuminant);
    kind =
        std::string("Light") + separator + (light.is_absolute() ? spectral::utf8(light.stem()) : spectral::utf8(light));
  } else if (filters(recipe.input) != filters(recipe.output)) {
    kind = "Filter";
  } else if (spectral::lowerCase(recipe.input.observer) != spectral::lowerCase(recipe.output.observer)) {
    kind = "Observer";
  }
  return family + separator + kind;
}

std::string lightOf(const sip::RecipePipeline& pipeline) {
  const auto name = [](const std::string& nameOrFile) {
    return spectral::utf8(spectral::pathOf(nameOrFile).filename());
  };
  std::string text = name(pipeline.illuminant);
  for (const auto& filter : pipeline.filters) {
    std::array<char, 32> density{};
    std::snprintf(density.data(), density.size(), ":%g", filter.density);
    text += " through " + name(filter.name) + density.data();
  }
  return text + ", " + name(pipeline.observer);
}

/// Where the files of a config go, and what must not give way to them.
class Places {
 public:
  /// @param folders    of the config and of its base
  /// @param lutFolder  of this config's files
  Places(const ConfigFacts& facts, const std::vector<fs::path>& folders, fs::path lutFolder,
         const std::set<std::string>& replaced)
      : m_lutFolder(std::move(lutFolder)),
        m_used(facts, folders, replaced),
        m_remedy(replaced.empty() ? "rename the recipe, or name another --lut-folder"
                                  : "renew that look too, or name another --lut-folder") {
    for (const std::string& look : facts.looks) {
      if (replaced.count(look) == 0 && !look.empty()) {
        m_used.add(m_lutFolder / spectral::pathOf(fileName(look) + ".json"),
                   "is the certificate of look '" + look + "'");
      }
    }
  }

  /// A file for a look to write, before it is written.
  /// @param mark  what metamer's own have in their first bytes
  std::unique_ptr<spectral::PendingFile> file(const std::string& name, const std::string& look, const char* mark) {
    const fs::path path = m_lutFolder / spectral::pathOf(name);
    const auto [own, isNew] = m_looks.emplace(spectral::lowerCase(name), look);
    if (!isNew) {
      throw InputError(spectral::utf8(path), "output", "",
                       "would hold both '" + own->second + "' and '" + look + "'; rename one of the recipes");
    }
    m_used.refuse(path, m_remedy);
    refuseForeign(path, mark);
    return std::make_unique<spectral::PendingFile>(path);
  }

  const UsedFiles& used() const { return m_used; }

 private:
  fs::path m_lutFolder;
  UsedFiles m_used;
  const char* m_remedy;
  std::map<std::string, std::string> m_looks;  ///< lower-case file name to the look that it is for
};

/// Files of the LUT folder that replaced looks had read, and that nothing reads now.
std::vector<std::string> unusedFiles(const ConfigFacts& before, const ConfigFacts& after, const fs::path& folder,
                                     const std::string& lutFolder, const std::set<std::string>& replaced) {
  const UsedFiles still(after, {folder}, {});
  std::vector<std::string> unused;
  for (const ConfigFile& file : before.fileUses) {
    const fs::path name = spectral::pathOf(file.src).filename();
    const std::string path = spectral::utf8(spectral::pathOf(lutFolder) / name);
    std::error_code none;
    if (replaced.count(file.user) != 0 && fs::is_regular_file(folder / spectral::pathOf(path), none) &&
        still.userOf(folder / spectral::pathOf(path)).empty() &&
        std::find(unused.begin(), unused.end(), path) == unused.end()) {
      unused.push_back(path);
    }
  }
  return unused;
}

/// What it does, and how well, in four lines; the certificate says more.
std::string descriptionOf(const ConfigEntry& entry) {
  const Certificate& certificate = entry.certificate;
  const sip::ErrorProtocol::Report& error = certificate.error;
  std::array<char, 200> figures{};
  std::snprintf(figures.data(), figures.size(),
                "CIEDE2000 against the spectral engine: mean %.2f, p99 %.2f, max %.2f, stops %+d to %+d", error.mean,
                error.p99, error.max, certificate.probes.lowestStop, certificate.probes.highestStop);
  std::array<char, 64> adaptation{};
  std::snprintf(adaptation.data(), adaptation.size(), "adaptation %g, ", certificate.recipe.adaptation);
  return "From " + lightOf(certificate.recipe.input) + "\nto " + lightOf(certificate.recipe.output) + "\n" +
         adaptation.data() + nameOf(certificate.representation) +
         (certificate.size > 0 ? " of " + std::to_string(certificate.size) : "") + ", metamer " + toolVersion() + "\n" +
         figures.data() + "\n";
}

}  // namespace

ConfigReport writeConfig(const std::vector<sip::Recipe>& recipes, const spectral::DataLibrary& library,
                         const fs::path& file, const ConfigOptions& options) {
  if (options.lutFolder.empty() ||
      spectral::pathOf(options.lutFolder).filename() != spectral::pathOf(options.lutFolder) ||
      options.lutFolder.find_first_of(":;$% ") != std::string::npos || options.lutFolder.front() == '.') {
    throw InputError("", "LUT folder", options.lutFolder, "must be one name, of a folder beside the config");
  }
  if (options.size != 0) {
    spectral::requireWithin("size", options.size, kSmallestTable, kLargestTable);
  }
  if (options.tolerance) {
    spectral::requireAbove("tolerance", *options.tolerance, 0);
  }
  std::error_code none;
  const fs::path base = options.base.empty() && options.replaces && fs::exists(file, none) ? file : options.base;
  const ConfigDocument document =
      base.empty() ? ConfigDocument(newConfigText(options.name.empty() ? spectral::utf8(file.stem()) : options.name,
                                                  options.description, options.lutFolder, library),
                                    spectral::utf8(file))
                   : openBaseConfig(base, file);
  const ConfigFacts& facts = document.facts();
  const std::string where = base.empty() ? spectral::utf8(file) : spectral::utf8(base);
  const std::set<std::string> replaced = checkNames(recipes, facts, where, options.replaces);

  // The places first: what cannot be written is not worth the work.
  const fs::path folder = fs::absolute(file).lexically_normal().parent_path();
  const bool hasFolder = !base.empty() && !isBuiltInConfig(spectral::utf8(base));
  const fs::path baseFolder = hasFolder ? fs::absolute(base).parent_path() : folder;
  Places places(facts, {folder, baseFolder}, folder / spectral::pathOf(options.lutFolder), replaced);
  places.used().refuse(file, "name another file for the config");
  spectral::PendingFile config(file);
  if (config.isStream()) {
    throw InputError(spectral::utf8(file), "output", "",
                     "is a device or pipe, and a config has files beside it; name a file");
  }
  const fs::path lutFolder = folder / spectral::pathOf(options.lutFolder);
  const spectral::PendingFolder madeForLuts(lutFolder);
  if (!base.empty()) {
    checkLoads(document.with("", "", ""), facts, folder, {}, where);
  }

  const LutPlace place = placeOfLuts(facts, options.lutFolder);
  ConfigReport report;
  std::vector<ConfigItem> items;
  std::vector<ConfigItem> pendingItems;  // the same with the files' names of now, to be loaded
  const std::vector<ConfigCore> cores = coresOf(recipes, facts, library, where);
  std::map<std::string, std::unique_ptr<spectral::PendingFile>> pending;  // by the name they will have
  const auto nameOfLut = [](const ConfigCore& core) { return fileName(core.name) + ".ctf"; };
  const auto nameOfCertificate = [](const CoreUse& use) { return fileName(use.recipe.name) + ".json"; };
  for (const ConfigCore& core : cores) {
    pending[nameOfLut(core)] = places.file(nameOfLut(core), core.name, "metamer");
    refuseShadows(facts, place.prefix + nameOfLut(core), options.lutFolder, file);
    for (const CoreUse& use : core.uses) {
      pending[nameOfCertificate(use)] = places.file(nameOfCertificate(use), use.recipe.name, "metamer_certificate");
    }
  }
  std::vector<spectral::PendingFile*> written;
  for (const ConfigCore& core : cores) {
    const auto done = static_cast<double>(&core - cores.data());
    const auto progress = [&](double share) {
      if (options.progress) {
        options.progress((done + share) / static_cast<double>(cores.size()));
      }
    };
    progress(0);
    const BakedCore baked = bakeCore(core, library, options.size, options.tolerance, lutFolder);
    const std::string lutName = nameOfLut(core);
    std::string pendingName;
    fs::path lutPath;
    if (!baked.lutText.empty()) {
      spectral::PendingFile& lut = *pending.at(lutName);
      lut.write(baked.lutText);
      written.push_back(&lut);
      lutPath = lut.path();
      pendingName = spectral::utf8(lutPath.filename());
    }
    for (const CoreUse& use : core.uses) {
      ConfigEntry entry;
      entry.name = use.recipe.name;
      entry.processSpace = core.processSpace;
      entry.pixelSpace = use.pixelSpace;
      entry.file = baked.lutText.empty() ? "" : options.lutFolder + "/" + lutName;
      const std::vector<ConfigStep> steps = stepsOf(core, use, baked, place.prefix + lutName, library);
      entry.certificate = certificateOf(core, use, baked, lutPath, library);

      ConfigItem item{entry.name,
                      entry.processSpace,
                      entry.pixelSpace,
                      familyOf(use.recipe, options.family, facts.familySeparator),
                      use.encoding,
                      descriptionOf(entry),
                      steps};
      items.push_back(item);
      for (ConfigStep& step : item.steps) {
        if (std::holds_alternative<std::string>(step)) {
          step = place.prefix + pendingName;
        }
      }
      pendingItems.push_back(std::move(item));

      written.push_back(pending.at(nameOfCertificate(use)).get());
      written.back()->write(entry.certificate.json());
      report.entries.push_back(std::move(entry));
    }
  }
  const auto textWith = [&](const std::vector<ConfigItem>& some) {
    return document.with(looksYaml(some), namedTransformsYaml(some), place.searchFolder, "", !replaced.empty());
  };
  report.isLoaded = checkLoads(textWith(pendingItems), facts, folder, pendingItems, where);
  report.majorVersion = facts.majorVersion;
  report.minorVersion = facts.minorVersion;
  const std::string text = textWith(items);
  config.write(text);
  report.unused = unusedFiles(facts, ConfigDocument(text, where).facts(), folder, options.lutFolder, replaced);
  written.push_back(&config);
  spectral::commitAll(written);
  return report;
}

fs::path certificateOfLook(const fs::path& config, const std::string& look) {
  std::error_code none;
  if (look.empty() || !fs::is_regular_file(config, none) || config.extension() == ".ocioz") {
    return {};
  }
  std::vector<std::string> folders =
      ConfigDocument(spectral::readTextFile(config), spectral::utf8(config)).facts().searchPath;
  folders.push_back(ConfigOptions().lutFolder);
  for (const std::string& folder : folders) {
    const fs::path file = config.parent_path() / spectral::pathOf(folder) / spectral::pathOf(fileName(look) + ".json");
    if (fs::is_regular_file(file, none)) {
      return file;
    }
  }
  return {};
}

}  // namespace metamer::ocio
