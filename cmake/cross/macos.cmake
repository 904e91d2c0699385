# SPDX-License-Identifier: Apache-2.0
# What the toolchain files of both of macOS's processors share.
set(CMAKE_SYSTEM_NAME Darwin)
set(CMAKE_SYSTEM_PROCESSOR ${METAMER_MACOS_ARCHITECTURE})
include("${CMAKE_CURRENT_LIST_DIR}/zig.cmake")
# What came after macOS 11.0 would keep the plug-in from loading there.
string(APPEND CMAKE_CXX_FLAGS_INIT " -Werror=unguarded-availability-new")
set(CMAKE_USER_MAKE_RULES_OVERRIDE_CXX "${CMAKE_CURRENT_LIST_DIR}/macos_link.cmake")
