# SPDX-License-Identifier: Apache-2.0
# What toolchain files share: clang with the headers and libraries of other systems, as the package
# ziglang carries them. script/cross says where it lies; METAMER_ZIG_TARGET is one of zig's targets.
set(METAMER_ZIG "$ENV{METAMER_ZIG}" CACHE FILEPATH "The program zig")
if(NOT EXISTS "${METAMER_ZIG}")
  message(FATAL_ERROR "METAMER_ZIG is '${METAMER_ZIG}'; build with script/cross, or name the program zig")
endif()
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES METAMER_ZIG)

set(CMAKE_C_COMPILER "${METAMER_ZIG}" cc -target ${METAMER_ZIG_TARGET})
set(CMAKE_CXX_COMPILER "${METAMER_ZIG}" c++ -target ${METAMER_ZIG_TARGET})
foreach(language C CXX)
  # zig would write debug tables otherwise, fifty times the bundle's size.
  set(CMAKE_${language}_FLAGS_INIT "-g0")
  set(CMAKE_${language}_ARCHIVE_CREATE "\"${METAMER_ZIG}\" ar qc <TARGET> <OBJECTS>")
  set(CMAKE_${language}_ARCHIVE_APPEND "\"${METAMER_ZIG}\" ar q <TARGET> <OBJECTS>")
  set(CMAKE_${language}_ARCHIVE_FINISH "\"${METAMER_ZIG}\" ranlib <TARGET>")
endforeach()

# Libraries are those that script/cross made for this system, never those of the one it runs on.
set(CMAKE_FIND_ROOT_PATH "${CMAKE_PREFIX_PATH}")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
# OpenFX's headers are the same everywhere, and lie elsewhere.
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE BOTH)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
