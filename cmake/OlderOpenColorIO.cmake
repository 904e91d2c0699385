# SPDX-License-Identifier: Apache-2.0
# metamer_older_ocio: the system's OpenColorIO, 2.1 or newer, which tests and benchmarks run beside the one that is linked.
# No part of what is installed sees it.
include_guard(GLOBAL)

find_path(METAMER_OLDER_OCIO_INCLUDE_DIR OpenColorIO/OpenColorIO.h)
find_library(METAMER_OLDER_OCIO_LIBRARY OpenColorIO)
mark_as_advanced(METAMER_OLDER_OCIO_INCLUDE_DIR METAMER_OLDER_OCIO_LIBRARY)
if(NOT METAMER_OLDER_OCIO_INCLUDE_DIR OR NOT METAMER_OLDER_OCIO_LIBRARY)
  message(FATAL_ERROR "The tests and benchmarks need a system OpenColorIO, 2.1 or newer, beside the one that is linked: "
    "install it (Debian: libopencolorio-dev), or give -DBUILD_TESTING=OFF -DMETAMER_BENCHMARKS=OFF")
endif()

add_library(metamer_older_ocio INTERFACE)
target_include_directories(metamer_older_ocio SYSTEM INTERFACE "${METAMER_OLDER_OCIO_INCLUDE_DIR}")
target_link_libraries(metamer_older_ocio INTERFACE "${METAMER_OLDER_OCIO_LIBRARY}")
