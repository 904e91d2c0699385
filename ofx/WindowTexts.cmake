# SPDX-License-Identifier: Apache-2.0
# Sets window_texts_source: a source that holds the kernels over a window of an image, in each language that hosts' devices
# take, as device/window_text.h gives them out; window_texts_folder: the folder of the same texts as files, for tests.
include(MetamerTextParts)
set(window_texts_source "${CMAKE_CURRENT_BINARY_DIR}/window_texts.cpp")
set(window_texts_folder "${CMAKE_CURRENT_BINARY_DIR}/window_texts")
set(METAMER_WINDOW_TEXTS_FOLDER "${window_texts_folder}" CACHE INTERNAL "Folder of the plug-in's kernels as files")
set(map_texts "${PROJECT_SOURCE_DIR}/sip/src/device/text")
set(own_texts "${CMAKE_CURRENT_SOURCE_DIR}/src/device/text")

# The text of a language: <prelude> names its files.
function(window_text prelude output)
  set(whole "")
  foreach(part "${map_texts}/constants.prelude" "${map_texts}/${prelude}.prelude" "${own_texts}/window_${prelude}.prelude"
          "${own_texts}/signal_table.prelude" "${map_texts}/common.body" "${map_texts}/map.body" "${own_texts}/skin.body"
          "${own_texts}/window.body" "${own_texts}/window.entries" "${own_texts}/doubles.body")
    file(READ "${part}" text)
    string(APPEND whole "${text}\n")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${part}")
  endforeach()
  file(CONFIGURE OUTPUT "${output}" CONTENT "${whole}" @ONLY)
endfunction()

window_text(opencl "${window_texts_folder}/window.cl")
window_text(cuda "${window_texts_folder}/window.cu")
window_text(metal "${window_texts_folder}/window.metal")

# CUDA's as PTX, which drivers since 2017 (PTX 6.0, CUDA 9) make their own code of, for cards since 2014 (sm_50). Without a
# clang that has the target the plug-in is built without CUDA.
find_program(METAMER_CLANG NAMES clang clang-14 clang-16 clang-17 clang-18 clang-19 DOC "clang with the target nvptx64")
set(cuda_text "${window_texts_folder}/window.cu")
set(cuda_binary "${window_texts_folder}/window.ptx")
file(SHA256 "${cuda_text}" cuda_hash)
if(NOT EXISTS "${cuda_binary}" OR NOT "${METAMER_CUDA_HASH}" STREQUAL "${cuda_hash}")
  set(cuda_problem "no clang")
  if(METAMER_CLANG)
    execute_process(
      COMMAND "${METAMER_CLANG}" -x cuda --cuda-device-only -nocudainc -nocudalib --cuda-gpu-arch=sm_50
        -Xclang -target-feature -Xclang +ptx60 -ffp-contract=off -O2 -S -o "${cuda_binary}.new" "${cuda_text}"
      RESULT_VARIABLE cuda_result ERROR_VARIABLE cuda_problem OUTPUT_QUIET)
  endif()
  if(METAMER_CLANG AND cuda_result EQUAL 0)
    file(RENAME "${cuda_binary}.new" "${cuda_binary}")
  else()
    message(STATUS "The OFX plug-in is built without CUDA: ${cuda_problem}")
    file(WRITE "${cuda_binary}" "")
  endif()
  set(METAMER_CUDA_HASH "${cuda_hash}" CACHE INTERNAL "Of the text that the PTX was made of")
endif()

metamer_text_parts("${window_texts_source}" FUNCTION metamer::ofx::windowText HEADER device/window_text.h
  FILES "${window_texts_folder}/window.cl" "${cuda_binary}" "${window_texts_folder}/window.metal")
