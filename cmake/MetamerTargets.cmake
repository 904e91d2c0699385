# SPDX-License-Identifier: Apache-2.0
# One way to declare a folder's library, program or test, so that warnings, sanitizers and names are the same everywhere.

set(METAMER_SANITIZERS "" CACHE STRING "Comma-separated -fsanitize list, empty for none")

add_library(metamer_build_flags INTERFACE)
target_compile_features(metamer_build_flags INTERFACE cxx_std_20)
option(METAMER_WERROR "Warnings are errors (the presets have it on)" OFF)
if(MSVC)
  target_compile_options(metamer_build_flags INTERFACE /W4 $<$<BOOL:${METAMER_WERROR}>:/WX>
    /permissive- /utf-8 /Zc:__cplusplus /fp:precise)
else()
  target_compile_options(metamer_build_flags INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion $<$<BOOL:${METAMER_WERROR}>:-Werror>
    # A transform must not depend on the machine or compiler that ran it: no contraction into fused operations.
    -ffp-contract=off
    # GCC 12 reports overlapping copies inside std::string that cannot happen (GCC bug 105651).
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
endif()
# Nor on its caches: Eigen adds long sums up in parts as large as the first cache has room for. These are the sizes of
# Intel's newer processors.
target_compile_definitions(metamer_build_flags INTERFACE EIGEN_NO_CPUID EIGEN_DEFAULT_L1_CACHE_SIZE=49152
  EIGEN_DEFAULT_L2_CACHE_SIZE=2097152 EIGEN_DEFAULT_L3_CACHE_SIZE=33554432)
if(METAMER_SANITIZERS)
  target_compile_options(metamer_build_flags INTERFACE -fsanitize=${METAMER_SANITIZERS} -fno-omit-frame-pointer
    -fno-sanitize-recover=all
    # GCC takes instrumented optionals for uninitialised; the other builds keep the warning.
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_link_options(metamer_build_flags INTERFACE -fsanitize=${METAMER_SANITIZERS})
endif()

option(METAMER_COVERAGE "Count what runs (clang only): script/test --coverage" OFF)
if(METAMER_COVERAGE)
  target_compile_options(metamer_build_flags INTERFACE -fprofile-instr-generate -fcoverage-mapping)
  target_link_options(metamer_build_flags INTERFACE -fprofile-instr-generate)
endif()
if(METAMER_SANITIZERS OR METAMER_COVERAGE)
  # Clang says which loops instrumentation keeps from vector lanes that were asked for: here that is no fault.
  target_compile_options(metamer_build_flags INTERFACE $<$<CXX_COMPILER_ID:Clang>:-Wno-pass-failed>)
endif()

# metamer_precompile(<target>)  What nearly every source reads, read once: a third of a library's time. Only where all is built but
# once, as script/cross does: a source's own includes are then not proven.
option(METAMER_PRECOMPILED "Read the headers that most sources share once a library" OFF)
function(metamer_precompile target)
  if(METAMER_PRECOMPILED)
    target_precompile_headers(${target} PRIVATE <Eigen/Dense> <algorithm> <filesystem> <functional> <map> <memory> <optional> <string> <vector>)
  endif()
endfunction()

# metamer_library(<folder> [PUBLIC targets...] [PRIVATE targets...])
# The library of one folder, alias metamer::<folder>: headers in <folder>/include, sources in the rooms <folder>/src/*,
# which include each other's headers as "room/name.h".
function(metamer_library folder)
  cmake_parse_arguments(arg "" "" "PUBLIC;PRIVATE" ${ARGN})
  set(target metamer_${folder})
  file(GLOB sources CONFIGURE_DEPENDS src/*/*.cpp)
  add_library(${target} STATIC ${sources})
  add_library(metamer::${folder} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${folder} POSITION_INDEPENDENT_CODE ON
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_include_directories(${target} PRIVATE src)
  target_link_libraries(${target} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE} $<BUILD_INTERFACE:metamer_build_flags>)
  metamer_precompile(${target})
  install(TARGETS ${target} EXPORT metamerTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endfunction()

# metamer_test(<name> SOURCES ... [LINK targets...] [LABELS ...] [LONG suites...])
# A GoogleTest program, one ctest entry a suite: what a suite builds once in its process serves all of its cases. Labels:
# cpp, those given, and quick but for the suites that are LONG, which ctest starts first. The target cpp_tests builds all
# such programs.
add_custom_target(cpp_tests)
function(metamer_test name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINK;LABELS;LONG" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  target_include_directories(${name} PRIVATE "${PROJECT_SOURCE_DIR}/tests")
  target_link_libraries(${name} PRIVATE ${arg_LINK} metamer_build_flags GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE METAMER_TEST_DATA="${CMAKE_CURRENT_SOURCE_DIR}")
  add_dependencies(cpp_tests ${name})

  set(suites "${CMAKE_CURRENT_BINARY_DIR}/${name}_suites.cmake")
  set(discover "${PROJECT_SOURCE_DIR}/cmake/DiscoverSuites.cmake")
  add_custom_command(TARGET ${name} POST_BUILD BYPRODUCTS "${suites}" VERBATIM
    COMMAND "${CMAKE_COMMAND}" "-DPROGRAM=$<TARGET_FILE:${name}>" "-DNAME=${name}" "-DFOLDER=${CMAKE_CURRENT_BINARY_DIR}"
      "-DLABELS=cpp;${arg_LABELS}" "-DLONG=${arg_LONG}" "-DOUTPUT=${suites}" -P "${discover}")
  set_property(TARGET ${name} APPEND PROPERTY LINK_DEPENDS "${discover}")
  # ctest reads what the build wrote; a program that was not built is a test that cannot run.
  set(included "${CMAKE_CURRENT_BINARY_DIR}/${name}_tests.cmake")
  file(WRITE "${included}"
    "if(EXISTS [=[${suites}]=])\n  include([=[${suites}]=])\nelse()\n  add_test(${name}.not_built ${name}.not_built)\nendif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES "${included}")
endfunction()
