# SPDX-License-Identifier: Apache-2.0
# Sets report_page_source: a source that holds the files of pictures/report/page, as page_parts.h gives them out.
set(report_page_source "${CMAKE_CURRENT_BINARY_DIR}/page_parts.cpp")
file(GLOB report_page_files CONFIGURE_DEPENDS pictures/report/page/*)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${report_page_files})
set(report_page_bytes "")
set(report_page_choices "")
foreach(part IN LISTS report_page_files)
  get_filename_component(name "${part}" NAME)
  string(MAKE_C_IDENTIFIER "${name}" identifier)
  file(READ "${part}" bytes HEX)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
  string(APPEND report_page_bytes "const unsigned char ${identifier}[] = {${bytes}};\n")
  string(APPEND report_page_choices
    "  if (name == \"${name}\") {\n    return {reinterpret_cast<const char*>(${identifier}), sizeof ${identifier}};\n  }\n")
endforeach()
file(CONFIGURE OUTPUT "${report_page_source}" @ONLY CONTENT
[[#include "report/page_parts.h"

namespace {

@report_page_bytes@
}  // namespace

std::string_view metamer::lutgen::pagePart(std::string_view name) {
@report_page_choices@  return {};
}
]])
