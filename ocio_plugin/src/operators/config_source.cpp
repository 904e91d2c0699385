// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/config_source.h"

#include <filesystem>
#include <mutex>
#include <utility>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/library_words.h"
#include "metamer/spectral/missing_file_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/platform.h"
#include "metamer/spectral/text.h"
#include "operators/config_files.h"

namespace metamer::ocio {
namespace {

constexpr const char* kBuiltIn = "ocio://";

/// @param where, value  what an error names
OCIO::ConstConfigRcPtr read(const std::string& name, const std::string& where, const std::string& value,
                            const std::string& remedy) {
  std::error_code none;
  if (!isBuiltInConfig(name) && !std::filesystem::is_regular_file(spectral::pathOf(name), none)) {
    if (std::filesystem::exists(spectral::pathOf(name), none)) {
      throw spectral::InputError(where, "config", value, "is a folder, device or pipe; " + remedy);
    }
    throw spectral::MissingFileError(where, "config", value, "there is no such file; " + remedy);
  }
  try {
    OCIO::ConstConfigRcPtr config = OCIO::Config::CreateFromFile(name.c_str());
    refuseEndlessFiles(*config, value.empty() ? where : value);
    return config;
  } catch (const OCIO::Exception& error) {
    throw spectral::InputError(where, "config", value,
                               std::string("cannot be read by OpenColorIO ") + OCIO::GetVersion() + ": " +
                                   spectral::colourReason(error.what()) + "; " + remedy);
  }
}

}  // namespace

struct ConfigSource::State {
  std::string name;
  bool isFromEnvironment = false;
  std::once_flag isOpened;
  OCIO::ConstConfigRcPtr config;
};

ConfigSource::ConfigSource() : ConfigSource(OCIO::ConstConfigRcPtr()) {}

ConfigSource::ConfigSource(std::nullptr_t /*none*/) : ConfigSource() {}

ConfigSource::ConfigSource(OCIO::ConstConfigRcPtr config, std::string name) : m_state(std::make_shared<State>()) {
  m_state->config = std::move(config);
  m_state->name = std::move(name);
}

ConfigSource ConfigSource::environment() {
  ConfigSource source(nullptr, spectral::environmentValue("OCIO").value_or(""));
  source.m_state->isFromEnvironment = true;
  return source;
}

OCIO::ConstConfigRcPtr ConfigSource::open() const {
  State& state = *m_state;
  if (state.isFromEnvironment && !state.name.empty()) {
    std::call_once(state.isOpened, [&state] {
      state.config = read(state.name, "$OCIO", state.name,
                          "set $OCIO to a config that is there, or name a built-in space (lutgen list spaces)");
    });
  }
  return state.config;
}

const std::string& ConfigSource::name() const {
  return m_state->name;
}

bool isBuiltInConfig(const std::string& name) {
  return spectral::lowerCase(name).rfind(kBuiltIn, 0) == 0;
}

OCIO::ConstConfigRcPtr configNamed(const std::string& name) {
  return read(name, name, "", "name a config that is there");
}

}  // namespace metamer::ocio
