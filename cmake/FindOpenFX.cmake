# SPDX-License-Identifier: Apache-2.0
# OpenFX::Headers: the official C headers. OPENFX_ROOT is the OpenFX tree: given by the user, else the one that
# script/bootstrap fetched into cargo's cache (the crate pinned in ofx/headers). OPENFX_HOST_SUPPORT is set to its
# HostSupport folder where it carries one.
set(OPENFX_ROOT "" CACHE PATH "OpenFX tree with include/ofxCore.h; empty: the crate pinned in ofx/headers")

set(openfx_root "${OPENFX_ROOT}")
if(NOT openfx_root)
  file(STRINGS "${PROJECT_SOURCE_DIR}/ofx/headers/Cargo.toml" openfx_pin REGEX "^openfx-sys = ")
  string(REGEX MATCH "[0-9]+\\.[0-9]+\\.[0-9]+" openfx_version "${openfx_pin}")
  set(cargo_home "$ENV{CARGO_HOME}")
  if(NOT cargo_home)
    set(cargo_home "$ENV{HOME}/.cargo")
  endif()
  # The registry's own folder has a hash in its name.
  file(GLOB openfx_candidates "${cargo_home}/registry/src/*/openfx-sys-${openfx_version}/openfx")
  if(openfx_candidates)
    list(GET openfx_candidates 0 openfx_root)
  endif()
endif()

find_path(OpenFX_INCLUDE_DIR ofxImageEffect.h PATHS "${openfx_root}/include" NO_DEFAULT_PATH NO_CACHE)
set(OPENFX_HOST_SUPPORT "")
if(EXISTS "${openfx_root}/HostSupport/include/ofxhHost.h")
  set(OPENFX_HOST_SUPPORT "${openfx_root}/HostSupport")
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenFX REQUIRED_VARS OpenFX_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "run script/bootstrap --no-build (it fetches the headers), or give -DOPENFX_ROOT=<OpenFX tree>")

if(OpenFX_FOUND AND NOT TARGET OpenFX::Headers)
  add_library(OpenFX::Headers INTERFACE IMPORTED)
  target_include_directories(OpenFX::Headers INTERFACE "${OpenFX_INCLUDE_DIR}")
endif()
