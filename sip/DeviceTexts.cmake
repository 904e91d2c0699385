# SPDX-License-Identifier: Apache-2.0
# Sets device_texts_source: a source that holds the files of src/device/text, as device_texts.h gives them out.
include(MetamerTextParts)
set(device_texts_source "${CMAKE_CURRENT_BINARY_DIR}/device_texts.cpp")
file(GLOB device_text_files CONFIGURE_DEPENDS src/device/text/*)
metamer_text_parts("${device_texts_source}" FUNCTION metamer::sip::deviceTextPart HEADER device/device_texts.h
  FILES ${device_text_files})
