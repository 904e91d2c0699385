# SPDX-License-Identifier: Apache-2.0
# Which OpenColorIO is linked: the release that script/opencolorio.txt pins, which script/bootstrap fetched into the user's
# cache and which the install tree carries, or the system's.
set(METAMER_OCIO release CACHE STRING "OpenColorIO to link: release (script/opencolorio.txt), or system (2.1 or newer)")
set_property(CACHE METAMER_OCIO PROPERTY STRINGS release system)

if(METAMER_OCIO STREQUAL "release")
  # The folder's name, as script/fetch_opencolorio.py makes it.
  set(opencolorio_pin "${PROJECT_SOURCE_DIR}/script/opencolorio.txt")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${opencolorio_pin}")
  file(STRINGS "${opencolorio_pin}" opencolorio_line REGEX "^OpenColorIO==")
  string(REGEX MATCH "[0-9]+\\.[0-9]+\\.[0-9]+" METAMER_OCIO_VERSION "${opencolorio_line}")
  file(SHA256 "${opencolorio_pin}" opencolorio_hash)
  string(SUBSTRING "${opencolorio_hash}" 0 12 opencolorio_hash)
  set(opencolorio_cache "$ENV{XDG_CACHE_HOME}")
  if(NOT opencolorio_cache)
    set(opencolorio_cache "$ENV{HOME}/.cache")
  endif()
  set(METAMER_OCIO_ROOT "${opencolorio_cache}/metamer/opencolorio-${METAMER_OCIO_VERSION}-${opencolorio_hash}")
  set(opencolorio_remedy
    "run script/bootstrap --no-build (it fetches the release), or give -DMETAMER_OCIO=system for the system's")
elseif(METAMER_OCIO STREQUAL "system")
  set(METAMER_OCIO_ROOT "")
  set(METAMER_OCIO_VERSION 2.1)
  set(opencolorio_remedy "install it (Debian: libopencolorio-dev), or leave out -DMETAMER_OCIO=system")
else()
  message(FATAL_ERROR "METAMER_OCIO is '${METAMER_OCIO}'; write release or system")
endif()
find_package(OpenColorIO ${METAMER_OCIO_VERSION} REQUIRED)

# Where the install tree keeps the release: a folder of its own, so that no other program finds it by accident.
set(METAMER_OCIO_FOLDER "${CMAKE_INSTALL_LIBDIR}/metamer/opencolorio")
if(METAMER_OCIO_ROOT)
  install(FILES "${OpenColorIO_LIBRARY}" DESTINATION "${METAMER_OCIO_FOLDER}/lib"
    PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
  install(DIRECTORY "${METAMER_OCIO_ROOT}/include" DESTINATION "${METAMER_OCIO_FOLDER}")
  install(FILES "${METAMER_OCIO_ROOT}/LICENSE" "${METAMER_OCIO_ROOT}/THIRD-PARTY.md"
    DESTINATION "${CMAKE_INSTALL_DATADIR}/metamer/licences/OpenColorIO")
endif()

# metamer_run_with_opencolorio(<program>...)  Installed programs find the library beside them, wherever the tree is moved.
function(metamer_run_with_opencolorio)
  if(NOT METAMER_OCIO_ROOT)
    return()
  endif()
  file(RELATIVE_PATH to_library "${CMAKE_INSTALL_FULL_BINDIR}" "${CMAKE_INSTALL_PREFIX}/${METAMER_OCIO_FOLDER}/lib")
  foreach(program IN LISTS ARGN)
    set_target_properties(${program} PROPERTIES INSTALL_RPATH "$ORIGIN/${to_library}")
    if(CMAKE_SYSTEM_NAME STREQUAL "Linux")
      # Before LD_LIBRARY_PATH: a studio's may lead to a libOpenColorIO.so of another release.
      target_link_options(${program} PRIVATE -Wl,--disable-new-dtags)
    endif()
  endforeach()
endfunction()
