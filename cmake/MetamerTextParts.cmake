# SPDX-License-Identifier: Apache-2.0
# metamer_text_parts(<source> FUNCTION <name> HEADER <header> FILES file...)
# Writes a source that defines the function, from the name of a file to its text: the files lie in the program from then on.
# HEADER declares it.
function(metamer_text_parts source)
  cmake_parse_arguments(arg "" "FUNCTION;HEADER" "FILES" ${ARGN})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${arg_FILES})
  set(parts "")
  foreach(file IN LISTS arg_FILES)
    get_filename_component(name "${file}" NAME)
    file(READ "${file}" text)
    string(APPEND parts "    {\"${name}\", R\"metamer(${text})metamer\"},\n")
  endforeach()
  set(function "${arg_FUNCTION}")
  set(header "${arg_HEADER}")
  file(CONFIGURE OUTPUT "${source}" @ONLY CONTENT
[[#include "@header@"

#include <array>
#include <utility>

namespace {

constexpr std::pair<std::string_view, std::string_view> kTexts[] = {
@parts@};

}  // namespace

std::string_view @function@(std::string_view name) {
  for (const auto& [known, text] : kTexts) {
    if (known == name) {
      return text;
    }
  }
  return {};
}
]])
endfunction()
