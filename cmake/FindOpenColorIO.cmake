# SPDX-License-Identifier: Apache-2.0
# OpenColorIO::OpenColorIO, from METAMER_OCIO_ROOT (include/, lib/) where that is set, else the system's. Debian 12 installs
# OpenColorIO's own CMake package where CMake does not look, with a broken prefix, so the library is found by its files.
# OpenColorIO_VERSION is the release, OpenColorIO_LIBRARY the file.
if(METAMER_OCIO_ROOT)
  unset(OpenColorIO_INCLUDE_DIR CACHE)
  unset(OpenColorIO_LIBRARY CACHE)
  find_path(OpenColorIO_INCLUDE_DIR OpenColorIO/OpenColorIO.h PATHS "${METAMER_OCIO_ROOT}/include" NO_DEFAULT_PATH NO_CACHE)
  find_library(OpenColorIO_LIBRARY OpenColorIO PATHS "${METAMER_OCIO_ROOT}/lib" NO_DEFAULT_PATH NO_CACHE)
else()
  find_path(OpenColorIO_INCLUDE_DIR OpenColorIO/OpenColorIO.h)
  find_library(OpenColorIO_LIBRARY OpenColorIO)
  mark_as_advanced(OpenColorIO_INCLUDE_DIR OpenColorIO_LIBRARY)
endif()

if(OpenColorIO_INCLUDE_DIR AND EXISTS "${OpenColorIO_INCLUDE_DIR}/OpenColorIO/OpenColorABI.h")
  file(STRINGS "${OpenColorIO_INCLUDE_DIR}/OpenColorIO/OpenColorABI.h" opencolorio_version_line
    REGEX "#define OCIO_VERSION_(FULL_)?STR +\"[0-9.]+")
  string(REGEX MATCH "[0-9]+\\.[0-9]+\\.[0-9]+" OpenColorIO_VERSION "${opencolorio_version_line}")
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenColorIO
  REQUIRED_VARS OpenColorIO_LIBRARY OpenColorIO_INCLUDE_DIR VERSION_VAR OpenColorIO_VERSION
  REASON_FAILURE_MESSAGE "${release_remedy}")

if(OpenColorIO_FOUND AND NOT TARGET OpenColorIO::OpenColorIO)
  add_library(OpenColorIO::OpenColorIO SHARED IMPORTED)
  set_target_properties(OpenColorIO::OpenColorIO PROPERTIES
    IMPORTED_LOCATION "${OpenColorIO_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${OpenColorIO_INCLUDE_DIR}")
endif()
