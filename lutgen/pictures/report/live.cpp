// SPDX-License-Identifier: Apache-2.0
#include "report/live.h"

#include <filesystem>
#include <string_view>

#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/platform.h"
#include "metamer/spectral/spectral_files.h"

namespace metamer::lutgen {
namespace {

/// The element from which the page's script reads settings.
constexpr std::string_view kHead = "<html";

std::string setting(const std::string& name, const std::string& value) {
  std::string escaped;
  for (const char letter : value) {
    escaped += letter == '&' ? "&amp;" : letter == '"' ? "&quot;" : letter == '<' ? "&lt;" : std::string(1, letter);
  }
  return " data-start-" + name + "=\"" + escaped + "\"";
}

std::string settingsOf(const sip::Recipe& recipe) {
  std::string text = setting("in", recipe.input.illuminant) + setting("out", recipe.output.illuminant) +
                     setting("adaptation", spectral::formatted("%g", recipe.adaptation));
  if (!recipe.output.filters.empty()) {
    text += setting("gel", recipe.output.filters.front().name) +
            setting("density", spectral::formatted("%g", recipe.output.filters.front().density));
  }
  return text;
}

}  // namespace

std::string livePage(const sip::Recipe& recipe) {
  const std::filesystem::path file =
      spectral::programFolder().parent_path() / "share" / "metamer" / "playground" / "metamer.html";
  std::error_code none;
  if (!std::filesystem::is_regular_file(file, none)) {
    throw spectral::InputError(spectral::utf8(file), "playground", "--live",
                               "is not there; script/playground makes the page, cmake --install puts it there");
  }
  std::string page = spectral::readTextFile(file);
  const std::size_t head = page.find(kHead);
  if (head == std::string::npos) {
    throw spectral::InputError(spectral::utf8(file), "playground", "--live",
                               "is no page of this release; make it again by script/playground");
  }
  return page.insert(head + kHead.size(), settingsOf(recipe));
}

}  // namespace metamer::lutgen
