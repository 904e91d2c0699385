// SPDX-License-Identifier: Apache-2.0
#include "operators/lut_file.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <vector>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/text.h"
#include "operators/cube_domain.h"

namespace metamer::ocio {
namespace {

using spectral::InputError;
namespace fs = std::filesystem;

/// References stand before tables: more of a file is not searched.
constexpr std::size_t kSearchedBytes = 4U << 20U;

std::string startOf(const fs::path& file) {
  std::string text(kSearchedBytes, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

bool isCtf(const fs::path& file) {
  const std::string extension = spectral::lowerCase(spectral::utf8(file.extension()));
  return extension == ".ctf" || extension == ".clf";
}

/// An attribute of an XML element, empty without it.
std::string attribute(const std::string& element, const std::string& name) {
  for (std::size_t at = element.find(name); at != std::string::npos; at = element.find(name, at + 1)) {
    const std::size_t equals = element.find_first_not_of(" \t\r\n", at + name.size());
    const bool isWhole = at > 0 && std::isspace(static_cast<unsigned char>(element[at - 1])) != 0;
    if (!isWhole || equals == std::string::npos || element[equals] != '=') {
      continue;
    }
    const std::size_t open = element.find_first_of("\"'", equals);
    const std::size_t close = open == std::string::npos ? open : element.find(element[open], open + 1);
    return close == std::string::npos ? "" : element.substr(open + 1, close - open - 1);
  }
  return "";
}

/// The files that a .ctf refers to, as it writes them.
std::vector<std::string> referencesOf(const fs::path& file) {
  const std::string text = startOf(file);
  std::vector<std::string> references;
  for (std::size_t at = text.find("Reference"); at != std::string::npos; at = text.find("Reference", at + 1)) {
    const std::size_t end = text.find('>', at);
    if (at == 0 || (text[at - 1] != '<' && text[at - 1] != ':') || end == std::string::npos) {
      continue;
    }
    const std::string path = attribute(text.substr(at, end - at), "path");
    if (!path.empty()) {
      references.push_back(path);
    }
  }
  return references;
}

/// @param way  from the first file to this one; all files met are added to `met`
void follow(const fs::path& file, std::vector<fs::path>& way, std::vector<fs::path>& met) {
  std::error_code none;
  way.push_back(fs::weakly_canonical(file, none));
  for (const std::string& reference : isCtf(file) ? referencesOf(file) : std::vector<std::string>{}) {
    const auto refuse = [&](const std::string& remedy) {
      throw InputError(spectral::utf8(file), "Reference", reference, remedy);
    };
    const fs::path target = file.parent_path() / spectral::pathOf(reference);
    if (fs::exists(target, none) && !fs::is_regular_file(target, none)) {
      refuse("is a device, pipe or folder; refer to a LUT file");
    }
    if (std::find(way.begin(), way.end(), fs::weakly_canonical(target, none)) != way.end()) {
      refuse("leads back to this file; remove the reference");
    }
    constexpr std::size_t kDeepest = 32;
    if (way.size() > kDeepest) {
      refuse("is one of more than 32 references in a row; put the steps into one file");
    }
    if (fs::exists(target, none)) {
      met.push_back(target);
      follow(target, way, met);
    }
  }
  way.pop_back();
}

}  // namespace

void refuseOddLut(const fs::path& file) {
  std::error_code none;
  if (fs::exists(file, none) && !fs::is_regular_file(file, none)) {
    throw InputError(spectral::utf8(file), "LUT", "", "is a device, pipe or folder; give a LUT file");
  }
  if (spectral::lowerCase(spectral::utf8(file.extension())) == ".cube") {
    refuseOddDomain(file, startOf(file));
  }
  filesReferredTo(file);
}

std::vector<fs::path> filesReferredTo(const fs::path& file) {
  std::vector<fs::path> way;
  std::vector<fs::path> met;
  follow(file, way, met);
  return met;
}

std::string remedyOfLut(const fs::path& file) {
  struct Keyword {
    const char* name;
    const char* remedy;
  };
  constexpr const char* kVideo =
      "marks a LUT of DaVinci Resolve for video-range signals (64 to 940 of 1023), which no other reader takes; export "
      "it again for full range, or scale the signals and remove the line";
  const std::string text = startOf(file);
  for (const Keyword& keyword : {Keyword{"LUT_IN_VIDEO_RANGE", kVideo}, Keyword{"LUT_OUT_VIDEO_RANGE", kVideo}}) {
    const std::size_t at = text.find(keyword.name);
    if (at != std::string::npos) {
      const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
      return "line " + std::to_string(line) + ": " + keyword.name + " " + keyword.remedy;
    }
  }
  return "";
}

}  // namespace metamer::ocio
