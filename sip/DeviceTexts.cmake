# SPDX-License-Identifier: Apache-2.0
# Sets device_texts_source: a source that holds the files of src/device/text, as device_texts.h gives them out.
set(device_texts_source "${CMAKE_CURRENT_BINARY_DIR}/device_texts.cpp")
file(GLOB device_text_files CONFIGURE_DEPENDS src/device/text/*)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${device_text_files})
set(device_texts "")
foreach(file IN LISTS device_text_files)
  get_filename_component(name "${file}" NAME)
  file(READ "${file}" text)
  string(APPEND device_texts "    {\"${name}\", R\"metamer(${text})metamer\"},\n")
endforeach()
file(CONFIGURE OUTPUT "${device_texts_source}" @ONLY CONTENT
[[#include "device/device_texts.h"

#include <array>
#include <utility>

namespace {

constexpr std::pair<std::string_view, std::string_view> kTexts[] = {
@device_texts@};

}  // namespace

std::string_view metamer::sip::deviceTextPart(std::string_view name) {
  for (const auto& [known, text] : kTexts) {
    if (known == name) {
      return text;
    }
  }
  return {};
}
]])
