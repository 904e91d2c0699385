# SPDX-License-Identifier: Apache-2.0
# macOS 11.0 and newer, Intel's processors, from Linux.
set(METAMER_MACOS_ARCHITECTURE x86_64)
set(METAMER_ZIG_TARGET x86_64-macos.11.0)
include("${CMAKE_CURRENT_LIST_DIR}/macos.cmake")
