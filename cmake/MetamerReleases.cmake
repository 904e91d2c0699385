# SPDX-License-Identifier: Apache-2.0
# The releases that metamer links and carries, as script/releases pins them and script/bootstrap fetches them into the
# user's cache; and how installed programs find them.
include_guard(GLOBAL)

# metamer_release(<Title> <option's value> <variable>)
# Sets <variable>_ROOT, <variable>_VERSION and release_remedy. The option's value is release, or system: then the root is
# empty and the version is left alone.
function(metamer_release title choice variable)
  string(TOLOWER "${title}" name)
  if(choice STREQUAL "release")
    # The folder's name, as script/releases/fetch.py makes it.
    set(pin "${PROJECT_SOURCE_DIR}/script/releases/${name}.txt")
    set_property(DIRECTORY "${PROJECT_SOURCE_DIR}" APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${pin}")
    file(STRINGS "${pin}" line REGEX "^[A-Za-z]+==")
    string(REGEX MATCH "[0-9]+\\.[0-9]+\\.[0-9]+(\\.[0-9]+)?" version "${line}")
    file(SHA256 "${pin}" hash)
    string(SUBSTRING "${hash}" 0 12 hash)
    set(cache "$ENV{XDG_CACHE_HOME}")
    if(NOT cache)
      set(cache "$ENV{HOME}/.cache")
    endif()
    set(${variable}_ROOT "${cache}/metamer/${name}-${version}-${hash}" PARENT_SCOPE)
    set(${variable}_VERSION "${version}" PARENT_SCOPE)
    set(release_remedy "run script/bootstrap --no-build (it fetches the release), or give -D${variable}=system for the system's"
      PARENT_SCOPE)
  elseif(choice STREQUAL "system")
    set(${variable}_ROOT "" PARENT_SCOPE)
    set(release_remedy "install it (Debian: lib${name}-dev), or leave out -D${variable}=system" PARENT_SCOPE)
  else()
    message(FATAL_ERROR "${variable} is '${choice}'; write release or system")
  endif()
endfunction()

# metamer_install_release(<Title> <root> <library>...)
# A folder of its own in the install tree, lib/metamer/<title>, so that no other program finds it by accident.
function(metamer_install_release title root)
  string(TOLOWER "${title}" name)
  set(folder "${CMAKE_INSTALL_LIBDIR}/metamer/${name}")
  install(FILES ${ARGN} DESTINATION "${folder}/lib"
    PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
  install(DIRECTORY "${root}/include" DESTINATION "${folder}")
  file(GLOB licences "${root}/LICENSE*" "${root}/THIRD-PARTY.md")
  install(FILES ${licences} DESTINATION "${CMAKE_INSTALL_DATADIR}/metamer/licences/${title}")
endfunction()

# metamer_run_with_releases(<program>...)  Installed programs find the libraries beside them, wherever the tree is moved.
function(metamer_run_with_releases)
  if(NOT METAMER_OCIO_ROOT AND NOT METAMER_OIIO_ROOT)
    return()
  endif()
  file(RELATIVE_PATH to_libraries "${CMAKE_INSTALL_FULL_BINDIR}" "${CMAKE_INSTALL_FULL_LIBDIR}/metamer")
  foreach(program IN LISTS ARGN)
    set_target_properties(${program} PROPERTIES
      INSTALL_RPATH "$ORIGIN/${to_libraries}/opencolorio/lib;$ORIGIN/${to_libraries}/openimageio/lib")
    if(CMAKE_SYSTEM_NAME STREQUAL "Linux")
      # Before LD_LIBRARY_PATH: a studio's may lead to other releases of the same libraries.
      target_link_options(${program} PRIVATE -Wl,--disable-new-dtags)
    endif()
  endforeach()
endfunction()
