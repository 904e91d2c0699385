// SPDX-License-Identifier: Apache-2.0
#include "config/used_files.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <system_error>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/platform.h"
#include "operators/lut_file.h"

namespace metamer::ocio {
namespace {

namespace fs = std::filesystem;

/// Stands in a path for what a variable may be; no path has it.
constexpr char kAnything = '\x01';

bool isOfName(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

std::string valueOf(const std::string& name, const ConfigFacts& facts) {
  if (const std::optional<std::string> value = spectral::environmentValue(name)) {
    return *value;
  }
  const auto found = facts.environment.find(name);
  return found == facts.environment.end() || found->second.find_first_of("$%") != std::string::npos
             ? std::string(1, kAnything)
             : found->second;
}

/// $NAME, ${NAME} and %NAME% replaced, as OpenColorIO does.
std::string withVariables(const std::string& text, const ConfigFacts& facts) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t begin = at + 1;
    std::size_t end = begin;
    std::size_t behind = begin;
    if (text.compare(at, 2, "${") == 0) {
      begin = at + 2;
      end = std::min(text.find('}', begin), text.size());
      behind = end + 1;
    } else if (text[at] == '%' && text.find('%', begin) != std::string::npos) {
      end = text.find('%', begin);
      behind = end + 1;
    } else if (text[at] == '$') {
      while (end < text.size() && isOfName(text[end])) {
        ++end;
      }
      behind = end;
    }
    if (end > begin) {
      result += valueOf(text.substr(begin, end - begin), facts);
      at = behind;
    } else {
      result += text[at++];
    }
  }
  return result;
}

/// Whether a path is what a pattern may stand for.
bool matches(std::string_view pattern, std::string_view path) {
  const std::size_t mark = pattern.find(kAnything);
  if (mark == std::string_view::npos) {
    return pattern == path;
  }
  if (path.substr(0, mark) != pattern.substr(0, mark)) {
    return false;
  }
  const std::string_view rest = pattern.substr(mark + 1);
  for (std::size_t at = mark; at <= path.size(); ++at) {
    if (matches(rest, path.substr(at))) {
      return true;
    }
  }
  return false;
}

std::string realPath(const fs::path& file) {
  std::error_code none;
  const fs::path path = fs::weakly_canonical(fs::absolute(file), none);
  return spectral::utf8(none ? fs::absolute(file).lexically_normal() : path);
}

}  // namespace

UsedFiles::UsedFiles(const ConfigFacts& facts, const std::vector<fs::path>& folders,
                     const std::set<std::string>& replaced) {
  std::vector<std::string> searchPath = facts.searchPath;
  if (searchPath.empty()) {
    searchPath.emplace_back(".");
  }
  for (const ConfigFile& file : facts.fileUses) {
    if (replaced.count(file.user) != 0) {
      continue;
    }
    const std::string user =
        file.user.empty() ? "is read by the config" : "is read by look or named transform '" + file.user + "'";
    const std::string src = withVariables(file.src, facts);
    for (const std::string& entry : searchPath) {
      for (const fs::path& folder : folders) {
        const fs::path place = folder / spectral::pathOf(withVariables(entry, facts)) /
                               spectral::pathOf(src);  // an absolute src stands alone
        if (spectral::utf8(place).find(kAnything) == std::string::npos) {
          addWithReferences(spectral::utf8(place), user);
        } else {
          m_uses.push_back({spectral::utf8(fs::absolute(place).lexically_normal()), user});
        }
      }
    }
  }
}

void UsedFiles::addWithReferences(const std::string& path, const std::string& user) {
  add(spectral::pathOf(path), user);
  std::error_code none;
  if (fs::is_regular_file(spectral::pathOf(path), none)) {
    for (const fs::path& file : filesReferredTo(spectral::pathOf(path))) {
      add(file, user);
    }
  }
}

void UsedFiles::add(const fs::path& file, const std::string& user) {
  m_uses.push_back({realPath(file), user});
}

std::string UsedFiles::userOf(const fs::path& file) const {
  const std::string real = realPath(file);
  const std::string plain = spectral::utf8(fs::absolute(file).lexically_normal());
  std::error_code none;
  for (const Use& use : m_uses) {
    if (matches(use.pattern, real) || matches(use.pattern, plain) ||
        fs::equivalent(spectral::pathOf(use.pattern), file, none)) {
      return use.user;
    }
  }
  return {};
}

void UsedFiles::refuse(const fs::path& file, const std::string& remedy) const {
  const std::string user = userOf(file);
  if (!user.empty()) {
    throw spectral::InputError(spectral::utf8(file), "output", "", user + " of the base; " + remedy);
  }
}

}  // namespace metamer::ocio
