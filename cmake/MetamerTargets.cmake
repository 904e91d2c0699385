# SPDX-License-Identifier: Apache-2.0
# One way to declare a folder's library, program or test, so that warnings, sanitizers and names are the same everywhere.

set(METAMER_SANITIZERS "" CACHE STRING "Comma-separated -fsanitize list, empty for none")

add_library(metamer_build_flags INTERFACE)
target_compile_features(metamer_build_flags INTERFACE cxx_std_20)
target_compile_options(metamer_build_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror
  # A transform must not depend on the machine or compiler that ran it: no contraction into fused operations.
  -ffp-contract=off
  # GCC 12 reports overlapping copies inside std::string that cannot happen (GCC bug 105651).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
if(METAMER_SANITIZERS)
  target_compile_options(metamer_build_flags INTERFACE -fsanitize=${METAMER_SANITIZERS} -fno-omit-frame-pointer
    -fno-sanitize-recover=all)
  target_link_options(metamer_build_flags INTERFACE -fsanitize=${METAMER_SANITIZERS})
endif()

option(METAMER_COVERAGE "Count what runs (clang only): script/test --coverage" OFF)
if(METAMER_COVERAGE)
  target_compile_options(metamer_build_flags INTERFACE -fprofile-instr-generate -fcoverage-mapping)
  target_link_options(metamer_build_flags INTERFACE -fprofile-instr-generate)
endif()

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
  install(TARGETS ${target} EXPORT metamerTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endfunction()

# metamer_test(<name> SOURCES ... [LINK targets...])  A GoogleTest program, one ctest entry a test case.
function(metamer_test name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  target_include_directories(${name} PRIVATE "${PROJECT_SOURCE_DIR}/tests")
  target_link_libraries(${name} PRIVATE ${arg_LINK} metamer_build_flags GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE METAMER_TEST_DATA="${CMAKE_CURRENT_SOURCE_DIR}")
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 900)
endfunction()
