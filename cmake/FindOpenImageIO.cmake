# SPDX-License-Identifier: Apache-2.0
# OpenImageIO::OpenImageIO and OpenImageIO::OpenImageIO_Util, from METAMER_OIIO_ROOT (include/, lib/) where that is set, else
# by the system's own CMake package. OpenImageIO_VERSION is the release, OpenImageIO_LIBRARIES the files.
if(NOT METAMER_OIIO_ROOT)
  find_package(OpenImageIO ${OpenImageIO_FIND_VERSION} CONFIG)
  if(NOT OpenImageIO_FOUND AND OpenImageIO_FIND_REQUIRED)
    message(FATAL_ERROR "OpenImageIO was not found: ${release_remedy}")
  endif()
  return()
endif()

set(openimageio_libraries)
file(GLOB openimageio_files "${METAMER_OIIO_ROOT}/lib/libOpenImageIO*.so.*")
foreach(file IN LISTS openimageio_files)
  get_filename_component(name "${file}" NAME)
  if(name MATCHES "^lib(OpenImageIO|OpenImageIO_Util)\\.so\\.")
    list(APPEND openimageio_libraries "${file}")
    set(openimageio_${CMAKE_MATCH_1} "${file}")
  endif()
endforeach()
set(openimageio_header "${METAMER_OIIO_ROOT}/include/OpenImageIO/oiioversion.h")
unset(OpenImageIO_VERSION)
if(EXISTS "${openimageio_header}")
  file(STRINGS "${openimageio_header}" openimageio_lines REGEX "^#define OIIO_VERSION_(MAJOR|MINOR|PATCH|TWEAK) ")
  foreach(line IN LISTS openimageio_lines)
    string(REGEX MATCH "[0-9]+" number "${line}")
    list(APPEND OpenImageIO_VERSION ${number})
  endforeach()
  list(JOIN OpenImageIO_VERSION "." OpenImageIO_VERSION)
endif()
# The release's headers ask for these two, which it carries the code of but not the headers.
find_package(Imath 3.1)
find_package(fmt)

include(FindPackageHandleStandardArgs)
set(OpenImageIO_LIBRARIES ${openimageio_libraries})
find_package_handle_standard_args(OpenImageIO
  REQUIRED_VARS OpenImageIO_LIBRARIES openimageio_header Imath_FOUND fmt_FOUND VERSION_VAR OpenImageIO_VERSION
  REASON_FAILURE_MESSAGE "${release_remedy}")

if(OpenImageIO_FOUND AND NOT TARGET OpenImageIO::OpenImageIO)
  foreach(name OpenImageIO_Util OpenImageIO)
    add_library(OpenImageIO::${name} SHARED IMPORTED)
    set_target_properties(OpenImageIO::${name} PROPERTIES
      IMPORTED_LOCATION "${openimageio_${name}}"
      INTERFACE_INCLUDE_DIRECTORIES "${METAMER_OIIO_ROOT}/include"
      INTERFACE_LINK_LIBRARIES "Imath::Imath;fmt::fmt-header-only")
  endforeach()
  set_property(TARGET OpenImageIO::OpenImageIO APPEND PROPERTY INTERFACE_LINK_LIBRARIES OpenImageIO::OpenImageIO_Util)
endif()
