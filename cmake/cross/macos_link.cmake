# SPDX-License-Identifier: Apache-2.0
# How a plug-in for macOS is linked. zig's own linker makes programs and shared libraries alone, and hides no symbols; LLVM's
# makes bundles, and signs them. CMAKE_PREFIX_PATH ends in libraries, beside which script/cross laid the C++ library and what macOS exports.
find_program(METAMER_LD64 NAMES ld64.lld-19 REQUIRED)
get_filename_component(runtime "${CMAKE_PREFIX_PATH}/../runtime" ABSOLUTE)
# Flags go straight to the linker.
set(CMAKE_CXX_LINKER_WRAPPER_FLAG)
# The system's own functions come before the compiler's of the same name.
set(CMAKE_CXX_CREATE_SHARED_MODULE "\"${METAMER_LD64}\" -bundle -arch ${METAMER_MACOS_ARCHITECTURE} -platform_version macos 11.0 11.0 \
-adhoc_codesign -dead_strip -x <LINK_FLAGS> -o <TARGET> <OBJECTS> <LINK_LIBRARIES> \
\"${runtime}/libc++abi.a\" \"${runtime}/libc++.a\" \"${runtime}/libSystem.tbd\" \"${runtime}/libcompiler_rt.a\"")
